/// A cloud made of noise: flat below, billowing above (Pharr et al. 2023, section 11.4.5).
#include "media/box_medium.h"
#include "media/medium_fields.h"
#include "textures/noise.h"

namespace alhazen {

namespace {

struct Cloud final : BoxMedium, CrossSections {
    float density = 1, wispiness = 1, frequency = 5;

    static void describe(Fields<Cloud>& f) {
        f.about("A cloud made of noise. Its base is at y = 0 and its top near y = 1, in its own space.");
        f.field("density", &Cloud::density, "how thick its upper parts are").at_least(0);
        f.field("wispiness", &Cloud::wispiness, "how much its edges are torn").at_least(0);
        f.field("frequency", &Cloud::frequency, "how fine its billows are").above(0);
        describe_cross_sections(f);
        describe_box(f);
        f.example("cumulus", {make_float("sigma_a", 0.1f), make_float("sigma_s", 30), make_float("g", 0.6f)});
        f.example("smooth",
                  {make_float("wispiness", 0), make_float("frequency", 2), make_float("density", 2)});
    }
    void finish(const Node& node, BuildContext& context) {
        if (!place_box(node, context)) return;
        // The density is clamped to 1, and noise reaches it nearly everywhere.
        majorants_ = MajorantGrid(box_, {1, 1, 1}, [](const Bounds3&) { return 1.0f; });
    }

    MediumColors colors(const Wavelengths& lambda) const override {
        return {sigma_a.eval(lambda) * scale, sigma_s.eval(lambda) * scale, 0};
    }
    MediumPoint at(Vec3 p, const MediumColors& c, const Wavelengths&) const override {
        const float d = density_at(p);
        return {c.sigma_a * d, c.sigma_s * d, 0};
    }
    bool is_emissive() const override { return false; }

  private:
    float density_at(Vec3 p) const {
        Vec3 q = p * frequency;
        float strength = 0.05f * wispiness, scale_of_wisps = 10;
        for (int octave = 0; octave < 2 && wispiness > 0; ++octave) {
            q += noise_gradient(q * scale_of_wisps) * strength;
            strength *= 0.5f;
            scale_of_wisps *= 1.99f;
        }
        const float billows = 0.5f * fractal_noise(q, 0.5f, 5);
        const float above = std::clamp((1 - p.y) * 4.5f * density * billows, 0.0f, 1.0f);
        return std::clamp(above + 2 * std::max(0.0f, 0.5f - p.y), 0.0f, 1.0f);
    }
    // By differences as wide as the book's, which is part of the look.
    static Vec3 noise_gradient(Vec3 p) {
        constexpr float step = 0.01f;
        const float here = noise(p);
        return Vec3(noise(p + Vec3{step, 0, 0}) - here, noise(p + Vec3{0, step, 0}) - here,
                    noise(p + Vec3{0, 0, step}) - here) /
               step;
    }
};

} // namespace

Kind<Medium> cloud_medium() {
    return make_kind<Medium, Cloud>("cloud");
}

} // namespace alhazen
