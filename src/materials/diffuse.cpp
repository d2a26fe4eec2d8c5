/// Ideal matte surfaces (Lambert 1760): reflected light does not depend on the direction of view.
#include "materials/material.h"
#include "math/warp.h"

namespace alhazen {

namespace {

struct DiffuseBsdf final : Bsdf {
    Spectrum reflectance;

    explicit DiffuseBsdf(Spectrum r) : reflectance(r) {}

    Scatter eval(Vec3 wo, Vec3 wi, TransportMode) const override {
        if (!same_hemisphere(wo, wi)) return {};
        return {reflectance * (inv_pi * abs_cos_theta(wi)), cosine_hemisphere_pdf(abs_cos_theta(wi)),
                cosine_hemisphere_pdf(abs_cos_theta(wo))};
    }
    std::optional<BsdfSample> sample(Vec3 wo, float, Vec2 u2, TransportMode mode) const override {
        if (reflectance.is_black()) return std::nullopt;
        Vec3 wi = sample_cosine_hemisphere(u2);
        if (wo.z < 0) wi.z = -wi.z;
        Scatter s = eval(wo, wi, mode);
        if (s.pdf == 0) return std::nullopt;
        return BsdfSample{wi, s.f, s.pdf, s.pdf_reverse, lobes(), 1};
    }
    Lobes lobes() const override {
        return reflectance.is_black() ? Lobes::none : Lobes::reflection | Lobes::diffuse;
    }
    WhittedTerms whitted(Vec3) const override { return {.ambient = reflectance}; }
    std::optional<Spectrum> matte() const override { return reflectance * inv_pi; }
};

struct Diffuse final : Material {
    AlbedoTexture reflectance{0.5f};

    static void describe(Fields<Diffuse>& f) {
        f.about("Ideal matte surface: reflected light does not depend on the viewing direction.");
        f.field("reflectance", &Diffuse::reflectance, "fraction of light reflected").in(0, 1);
        f.example("grey", {});
        f.example("clay", {make_rgb("reflectance", 0.6f, 0.4f, 0.3f)});
        f.example("white", {make_float("reflectance", 1)});
        f.example("black", {make_float("reflectance", 0)});
    }
    bool needs_parameters() const override { return !reflectance.is_constant(); }
    Bsdf* at(const Hit& hit, Wavelengths& lambda, Arena& arena) const override {
        return arena.make<DiffuseBsdf>(clamp(reflectance.eval(TexturePoint(hit), lambda), 0, 1));
    }
    bool is_uniform() const override { return reflectance.is_constant(); }
};

} // namespace

Kind<Material> diffuse_material() {
    return make_kind<Material, Diffuse>("diffuse");
}

} // namespace alhazen
