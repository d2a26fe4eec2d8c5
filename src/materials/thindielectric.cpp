/// A window pane without thickness: both borders of a thin dielectric at once (Pharr et al. 2023, section
/// 9.5.1). Light goes straight on, or is mirrored.
#include "describe/spectrum_parameter.h"
#include "materials/fresnel.h"
#include "materials/material.h"

namespace alhazen {

namespace {

struct ThinDielectricBsdf final : Bsdf {
    float eta;

    explicit ThinDielectricBsdf(float eta_) : eta(eta_) {}

    // R + T R T + T R R R T + ... : light that bounces between the borders leaves on either side.
    float reflected(Vec3 wo) const {
        float r = fresnel_dielectric(abs_cos_theta(wo), eta);
        return r < 1 ? r + sqr(1 - r) * r / (1 - sqr(r)) : 1;
    }

    Scatter eval(Vec3, Vec3, TransportMode) const override { return {}; }
    std::optional<BsdfSample> sample(Vec3 wo, float u, Vec2, TransportMode) const override {
        if (wo.z == 0) return std::nullopt;
        float r = reflected(wo);
        if (u < r) return BsdfSample{{-wo.x, -wo.y, wo.z}, r, r, r, Lobes::reflection | Lobes::specular, 1};
        if (r == 1) return std::nullopt;
        return BsdfSample{-wo, 1 - r, 1 - r, 1 - r, Lobes::transmission | Lobes::specular, 1};
    }
    Lobes lobes() const override { return Lobes::reflection | Lobes::transmission | Lobes::specular; }
    WhittedTerms whitted(Vec3 wo) const override {
        float r = reflected(wo);
        return {.mirror = r, .refract = 1 - r, .eta = 1};
    }
};

struct ThinDielectric final : Material {
    UnboundedSpectrum eta{1.5f};

    static void describe(Fields<ThinDielectric>& f) {
        f.about("A thin pane of glass: reflects, or lets light through without bending it.");
        f.field("eta", &ThinDielectric::eta, "index of refraction of the pane over that of its surroundings")
            .above(0);
        Relief::describe(f);
        f.example("window", {});
        f.example("diamond pane", {make_float("eta", 2.42f)});
        f.example("soap", {make_spectrum("eta", "glass-BK7")});
    }

    bool needs_parameters() const override { return false; }
    Bsdf* at(const Hit&, Wavelengths& lambda, Arena& arena) const override {
        float index = lambda.hero(eta.eval(lambda));
        if (!eta.value.is_constant()) lambda.terminate_secondary();
        return arena.make<ThinDielectricBsdf>(index > 0 ? index : 1);
    }
};

} // namespace

Kind<Material> thindielectric_material() {
    return make_kind<Material, ThinDielectric>("thindielectric");
}

} // namespace alhazen
