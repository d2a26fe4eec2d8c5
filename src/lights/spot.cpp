/// A light without size that shines into a cone, full in the middle and fading smoothly towards the rim
/// (Pharr et al. 2023, section 12.2.1).
#include "lights/point_like.h"
#include "math/density.h"

namespace alhazen {
namespace {

/// 0 up to a, 1 from b on, a cubic without kinks between.
float smooth_step(float x, float a, float b) {
    if (a == b) return x < a ? 0.0f : 1.0f;
    float t = std::clamp((x - a) / (b - a), 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}

struct SpotLight final : PointLike {
    Vec3 to{0, 0, 1};
    float coneangle = 30, conedeltaangle = 5;

    static void describe(Fields<SpotLight>& f) {
        f.about("Shines from one point into a cone.");
        describe_point_like(f, "radiant intensity in the middle of the cone");
        describe_from(f);
        f.field("to", &SpotLight::to, "a point in the middle of the cone").unit("scene units");
        f.field("coneangle", &SpotLight::coneangle, "from the middle of the cone to where the light ends")
            .in(0, 180)
            .unit("degrees");
        f.field("conedeltaangle", &SpotLight::conedeltaangle, "width of the rim in which the light fades")
            .in(0, 180)
            .unit("degrees");
        f.example("lamp",
                  {make_rgb("I", 20, 20, 18), make_point3("from", {0, 4, 0}), make_point3("to", {1, 0, 1})});
        f.example("wide",
                  {make_float("coneangle", 100), make_float("conedeltaangle", 60), make_float("power", 500)});
        f.example("sharp", {make_float("coneangle", 20), make_float("conedeltaangle", 0)});
    }
    void finish(const Node& node, BuildContext& context) {
        auto middle = direction_between(from, to);
        if (!middle) {
            context.messages.add_error(node.place,
                                       "light \"spot\" has the same point for \"from\" and \"to\"; it "
                                       "needs a direction");
            return;
        }
        axis_ = middle->w;
        // A rim wider than the cone turns back on itself at the middle.
        float full = std::min(std::abs(coneangle - conedeltaangle), coneangle);
        cos_end_ = std::cos(radians(coneangle));
        cos_full_ = std::cos(radians(full));
        space_ = LightSpace(context.world_from_node);
        place(solid_angle(), node, context);
    }

    std::optional<LightSample> sample(const LightReceiver& at, Vec2,
                                      const Wavelengths& lambda) const override {
        return sample_point(at, lambda, [&](const Direction& to_light) {
            return falloff(space_.to_light(-to_light.w)) / to_light.distance_squared;
        });
    }
    std::optional<LeavingLight> sample_leaving(Vec2, Vec2 u2, const Wavelengths& lambda,
                                               float time) const override {
        if (solid_angle() == 0) return std::nullopt;
        Vec3 local = sample_falloff(u2), w = space_.to_world(local);
        return leave_point(w, falloff(local), pdf_leaving({}, w).direction, lambda, time);
    }
    /// In proportion to the light's falloff.
    LeavingPdf pdf_leaving(Vec3, Vec3 w) const override {
        return {1, falloff(space_.to_light(w)) / solid_angle() * space_.stretch(w)};
    }
    std::optional<LightBounds> bounds() const override {
        LightBounds b = point_bounds();
        if (!keeps_angles(space_.world_from_light())) return b;
        b.axis = space_.to_world(axis_);
        b.cos_normals = cos_full_;
        // A little wider than the rim, so that rounding never cuts into it.
        b.cos_falloff = std::cos(std::min(std::acos(cos_end_) - std::acos(cos_full_) + 2e-3f, pi));
        return b;
    }

  private:
    /// Of the intensity, along w in the light's space.
    float falloff(Vec3 w) const { return smooth_step(dot(w, axis_), cos_end_, cos_full_); }
    Vec3 sample_falloff(Vec2 u) const {
        const float full = 2 * pi * (1 - cos_full_) / solid_angle();
        // 1 - cos, which keeps its digits in narrow cones.
        float h = u.x * solid_angle() / (2 * pi);
        if (u.x >= full) {
            float t = sample_smooth_step(std::min((u.x - full) / (1 - full), 1.0f));
            h = lerp(t, 1 - cos_end_, 1 - cos_full_);
        }
        float sine = safe_sqrt(h * (2 - h)), phi = 2 * pi * u.y;
        return Frame::from_z(axis_).to_world({sine * std::cos(phi), sine * std::sin(phi), 1 - h});
    }
    /// Integral of the falloff over directions: the full cone, and half of the rim, about whose middle the
    /// cubic is point symmetric.
    float solid_angle() const { return 2 * pi * ((1 - cos_full_) + (cos_full_ - cos_end_) / 2); }

    LightSpace space_;
    Vec3 axis_{0, 0, 1};
    float cos_full_ = 1, cos_end_ = 1;
};

} // namespace

Kind<Light> spot_light() {
    return make_kind<Light, SpotLight>("spot");
}

} // namespace alhazen
