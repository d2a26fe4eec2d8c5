/// The same matter everywhere: haze, milk, water (Pharr et al. 2023, section 11.4.1).
#include "describe/spectrum_parameter.h"
#include "materials/presets.h"
#include "media/medium.h"

namespace alhazen {

namespace {

struct Homogeneous final : Medium {
    std::string preset;
    UnboundedSpectrum sigma_a{1}, sigma_s{1};
    IlluminantSpectrum Le{0};
    float Lescale = 1;

    static void describe(Fields<Homogeneous>& f) {
        f.about("Matter of one density everywhere.");
        f.field("preset", &Homogeneous::preset,
                "name of measured matter, instead of sigma_a and sigma_s; per mm");
        f.field("sigma_a", &Homogeneous::sigma_a, "how much light is absorbed per length").at_least(0);
        f.field("sigma_s", &Homogeneous::sigma_s, "how much light is scattered per length").at_least(0);
        f.field("Le", &Homogeneous::Le, "radiance of what absorbs: sigma_a times it is emitted per length");
        f.field("Lescale", &Homogeneous::Lescale, "factor on Le").at_least(0);
        describe_common(f);
        f.example("haze", {make_float("sigma_a", 0.01f), make_float("sigma_s", 0.2f), make_float("g", 0.7f)});
        f.example("milk", {make_string("preset", "Wholemilk"), make_float("scale", 100)});
        f.example("ember", {make_rgb("sigma_a", 0.1f, 0.4f, 1), make_float("sigma_s", 0),
                            make_rgb("Le", 1, 0.4f, 0.1f), make_float("Lescale", 2)});
    }
    void finish(const Node& node, BuildContext& context) {
        if (!preset.empty()) use_preset(node, context);
        // Coloured light in pbrt-v4's units: white with Le 1 shows as 1 where nothing else is.
        emitted_ =
            Le.value.scaled(Le.value.is_black() ? 0 : Lescale * Le.value.light_scale(context.color_mode));
        world_from_medium_ = Transform();
        phase_ = HenyeyGreenstein(g);
    }

    MediumColors colors(const Wavelengths& lambda) const override {
        return {sigma_a.eval(lambda) * scale, sigma_s.eval(lambda) * scale, emitted_.eval(lambda)};
    }
    MediumPoint at(Vec3, const MediumColors& c, const Wavelengths&) const override {
        return {c.sigma_a, c.sigma_s, c.Le};
    }
    bool is_emissive() const override { return !emitted_.is_black(); }

  private:
    void use_preset(const Node& node, BuildContext& context) {
        for (const char* other : {"sigma_a", "sigma_s"})
            if (const Parameter* p = node.find(other))
                context.messages.add_error(p->place,
                                           std::string("medium \"homogeneous\" has both \"preset\" and \"") +
                                               other + "\"; it takes one of them");
        if (auto found = find_medium_preset(*node.find("preset"), preset, context)) {
            sigma_a = {SpectrumValue::unbounded_rgb(srgb_space(), found->sigma_a), ""};
            sigma_s = {SpectrumValue::unbounded_rgb(srgb_space(), found->sigma_s), ""};
        }
    }

    SpectrumValue emitted_;
};

} // namespace

Kind<Medium> homogeneous_medium() {
    return make_kind<Medium, Homogeneous>("homogeneous");
}

} // namespace alhazen
