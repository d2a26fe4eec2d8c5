/// A light without size that shines alike in all directions: a bulb far smaller than its distance (Pharr et
/// al. 2023, section 12.2).
#include "lights/point_like.h"
#include "math/warp.h"

namespace alhazen {
namespace {

enum class Falloff { inverse_square, none };

} // namespace

template <>
struct EnumNames<Falloff> {
    static constexpr std::array names{"inverse-square", "none"};
};

namespace {

struct PointLight final : PointLike {
    Falloff falloff = Falloff::inverse_square;

    static void describe(Fields<PointLight>& f) {
        f.about("Shines from one point, alike in all directions.");
        describe_point_like(f, "radiant intensity");
        describe_from(f);
        f.field(
            "falloff", &PointLight::falloff,
            "how light fades with distance: with its square, or (as simple ray tracers have it) not at all");
        f.example("bulb", {make_rgb("I", 10, 8, 6), make_point3("from", {1, 3, -2})});
        f.example("lumens", {make_float("power", 800), make_float("scale", 2)});
        f.example("unfading", {make_rgb("I", .9f, .9f, .9f), make_point3("from", {5, 5, -10}),
                               make_string("falloff", "none")});
    }
    void finish(const Node& node, BuildContext& context) { place(4 * pi, node, context); }

    std::optional<LightSample> sample(const LightReceiver& at, Vec2,
                                      const Wavelengths& lambda) const override {
        return sample_point(at, lambda, [&](const Direction& to_light) {
            return falloff == Falloff::none ? 1.0f : 1 / to_light.distance_squared;
        });
    }
    std::optional<LeavingLight> sample_leaving(Vec2, Vec2 u2, const Wavelengths& lambda,
                                               float time) const override {
        auto s = leave_point(sample_sphere(u2), 1, sphere_pdf(), lambda, time);
        if (s) s->fades = falloff != Falloff::none;
        return s;
    }
    LeavingPdf pdf_leaving(Vec3, Vec3) const override { return {1, sphere_pdf()}; }
    std::optional<LightBounds> bounds() const override { return point_bounds(); }
    std::optional<EvenPoint> even_point(const Wavelengths& lambda) const override {
        return EvenPoint{position(), intensity(lambda), falloff != Falloff::none};
    }
};

} // namespace

Kind<Light> point_light() {
    return make_kind<Light, PointLight>("point");
}

} // namespace alhazen
