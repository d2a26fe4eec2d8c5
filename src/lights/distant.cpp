/// Parallel light from infinitely far away, such as sunlight without the sun's disk (Pharr et al. 2023,
/// section 12.3).
#include "lights/light.h"
#include "lights/light_parts.h"

namespace alhazen {
namespace {

struct DistantLight final : Light {
    IlluminantSpectrum L = white_light();
    float scale = 1;
    std::optional<float> illuminance;
    Vec3 from{0, 0, 0}, to{0, 0, 1};

    static void describe(Fields<DistantLight>& f) {
        f.about("Parallel light from infinitely far away, shining in the direction from -> to.");
        f.field("L", &DistantLight::L, "irradiance on a surface that faces the light").unit("W/m^2");
        f.field("scale", &DistantLight::scale, "factor on the light").at_least(0);
        f.field("illuminance", &DistantLight::illuminance,
                "illuminance on a surface that faces the light; when positive, a further factor")
            .unit("lx");
        f.field("from", &DistantLight::from, "where the light comes from").unit("scene units");
        f.field("to", &DistantLight::to, "where it goes").unit("scene units");
        f.example("sun", {make_rgb("L", 3, 2.8f, 2.5f), make_point3("from", {1, 2, 3}),
                          make_point3("to", {0, 0, 0})});
        f.example("measured", {make_float("illuminance", 20)});
    }
    void finish(const Node& node, BuildContext& context) {
        auto w = direction_between(to, from);
        if (!w) {
            context.messages.add_error(node.place,
                                       "light \"distant\" has the same point for \"from\" and \"to\"; it "
                                       "needs a direction");
            return;
        }
        take_default_color(node, "L", L);
        wi_ = normalize(context.world_from_node.vector(w->w));
        float s = scale * (is_given(illuminance) ? *illuminance : 1.0f);
        irradiance_ = calibrated(L.value, s, context.color_mode);
    }

    void prepare(const Bounds3& scene) override { extent_.set(scene); }
    std::optional<LightSample> sample(const LightReceiver& at, Vec2,
                                      const Wavelengths& lambda) const override {
        LightSample s;
        s.L = irradiance_.eval(lambda);
        if (s.L.is_black()) return std::nullopt;
        s.wi = wi_;
        s.pdf = 1;
        s.p = extent_.beyond(at.p, wi_);
        return s;
    }
    std::optional<LeavingLight> sample_leaving(Vec2 u1, Vec2, const Wavelengths& lambda,
                                               float time) const override {
        LeavingLight s;
        s.L = irradiance_.eval(lambda);
        if (s.L.is_black() || extent_.radius == 0) return std::nullopt;
        s.ray = {extent_.before(-wi_, u1), -wi_, infinity, time};
        s.pdf_position = 1 / extent_.disk_area();
        s.pdf_direction = 1;
        s.p = s.ray.o;
        return s;
    }
    LeavingPdf pdf_leaving(Vec3, Vec3) const override { return {1 / extent_.disk_area(), 1}; }
    bool is_delta() const override { return true; }
    bool is_far() const override { return true; }
    Spectrum power(const Wavelengths& lambda) const override {
        return irradiance_.eval(lambda) * extent_.disk_area();
    }

  private:
    SpectrumValue irradiance_;
    Vec3 wi_{0, 0, 1};
    SceneExtent extent_;
};

} // namespace

Kind<Light> distant_light() {
    return make_kind<Light, DistantLight>("distant");
}

} // namespace alhazen
