/// A light without size that shines alike in all directions: a bulb far smaller than its distance (Pharr et
/// al. 2023, section 12.2).
#include "lights/light.h"
#include "lights/light_parts.h"

namespace alhazen {
namespace {

enum class Falloff { inverse_square, none };

} // namespace

template <>
struct EnumNames<Falloff> {
    static constexpr std::array names{"inverse-square", "none"};
};

namespace {

struct PointLight final : Light {
    IlluminantSpectrum I = white_light();
    float scale = 1;
    std::optional<float> power_target;
    Vec3 from;
    Falloff falloff = Falloff::inverse_square;

    static void describe(Fields<PointLight>& f) {
        f.about("Shines from one point, alike in all directions.");
        f.field("I", &PointLight::I, "radiant intensity").unit("W/sr");
        f.field("scale", &PointLight::scale, "factor on the intensity").at_least(0);
        f.field("power", &PointLight::power_target,
                "luminous flux; when positive, the intensity is scaled to give it")
            .unit("lm");
        f.field("from", &PointLight::from, "where the light is").unit("scene units");
        f.field(
            "falloff", &PointLight::falloff,
            "how light fades with distance: with its square, or (as simple ray tracers have it) not at all");
        f.example("bulb", {make_rgb("I", 10, 8, 6), make_point3("from", {1, 3, -2})});
        f.example("lumens", {make_float("power", 800), make_float("scale", 2)});
        f.example("unfading", {make_rgb("I", .9f, .9f, .9f), make_point3("from", {5, 5, -10}),
                               make_string("falloff", "none")});
    }
    void finish(const Node&, BuildContext& context) {
        float s = scale;
        if (is_given(power_target)) s *= *power_target / (4 * pi);
        intensity_ = calibrated(I.value, s, context.color_mode);
        p_ = context.world_from_node.point(from);
    }

    std::optional<LightSample> sample(const LightReceiver& at, Vec2,
                                      const Wavelengths& lambda) const override {
        auto to_light = direction_between(at.p, p_);
        if (!to_light) return std::nullopt;
        LightSample s;
        s.L = intensity_.eval(lambda);
        if (falloff == Falloff::inverse_square) s.L = s.L / to_light->distance_squared;
        if (s.L.is_black()) return std::nullopt;
        s.wi = to_light->w;
        s.pdf = 1;
        s.p = p_;
        return s;
    }
    bool is_delta() const override { return true; }
    std::optional<LightBounds> bounds() const override {
        LightBounds b;
        b.bounds = {p_, p_};
        b.power = 4 * pi * brightness(intensity_);
        return b;
    }
    Spectrum power(const Wavelengths& lambda) const override { return 4 * pi * intensity_.eval(lambda); }

  private:
    SpectrumValue intensity_;
    Vec3 p_;
};

} // namespace

Kind<Light> point_light() {
    return make_kind<Light, PointLight>("point");
}

} // namespace alhazen
