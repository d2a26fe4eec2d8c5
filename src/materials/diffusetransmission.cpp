/// Thin matte sheets that light shines through: paper, leaves, lampshades. Both what is reflected and what
/// gets through goes everywhere alike (Lambert's law on both sides).
#include "materials/material.h"
#include "math/warp.h"

namespace alhazen {

namespace {

struct DiffuseTransmissionBsdf final : Bsdf {
    Spectrum reflectance, transmittance;

    DiffuseTransmissionBsdf(Spectrum r, Spectrum t) : reflectance(r), transmittance(t) {}

    Scatter eval(Vec3 wo, Vec3 wi, TransportMode) const override {
        if (wo.z == 0 || wi.z == 0) return {};
        const bool is_reflected = same_hemisphere(wo, wi);
        const float chance = is_reflected ? chance_to_reflect() : 1 - chance_to_reflect();
        const Spectrum& color = is_reflected ? reflectance : transmittance;
        return {color * (inv_pi * abs_cos_theta(wi)), chance * cosine_hemisphere_pdf(abs_cos_theta(wi)),
                chance * cosine_hemisphere_pdf(abs_cos_theta(wo))};
    }
    std::optional<BsdfSample> sample(Vec3 wo, float u, Vec2 u2, TransportMode mode) const override {
        if (lobes() == Lobes::none) return std::nullopt;
        const bool is_reflected = u < chance_to_reflect();
        Vec3 wi = sample_cosine_hemisphere(u2);
        if ((wo.z < 0) == is_reflected) wi.z = -wi.z;
        Scatter s = eval(wo, wi, mode);
        if (!(s.pdf > 0)) return std::nullopt;
        Lobes side = is_reflected ? Lobes::reflection : Lobes::transmission;
        return BsdfSample{wi, s.f, s.pdf, s.pdf_reverse, side | Lobes::diffuse, 1};
    }
    Lobes lobes() const override {
        Lobes all = Lobes::none;
        if (!reflectance.is_black()) all = all | Lobes::reflection | Lobes::diffuse;
        if (!transmittance.is_black()) all = all | Lobes::transmission | Lobes::diffuse;
        return all;
    }
    WhittedTerms whitted(Vec3) const override { return {.ambient = reflectance}; }

  private:
    float chance_to_reflect() const {
        const float r = reflectance.max(), t = transmittance.max();
        return r > 0 ? r / (r + t) : 0;
    }
};

struct DiffuseTransmission final : Material {
    AlbedoTexture reflectance{0.25f}, transmittance{0.25f};
    float scale = 1;

    static void describe(Fields<DiffuseTransmission>& f) {
        f.about("Thin matte sheet that light shines through: paper, leaves, lampshades.");
        f.field("reflectance", &DiffuseTransmission::reflectance, "fraction of light reflected").in(0, 1);
        f.field("transmittance", &DiffuseTransmission::transmittance, "fraction of light let through")
            .in(0, 1);
        f.field("scale", &DiffuseTransmission::scale, "factor of both").at_least(0);
        Relief::describe(f);
        f.example("paper", {});
        f.example("leaf", {make_rgb("reflectance", 0.1f, 0.3f, 0.05f),
                           make_rgb("transmittance", 0.2f, 0.4f, 0.02f), make_float("scale", 1.2f)});
        f.example("screen", {make_float("reflectance", 0), make_float("transmittance", 0.8f)});
        f.example("cloth", {make_float("reflectance", 0.6f), make_float("transmittance", 0)});
    }
    bool needs_parameters() const override {
        return !reflectance.is_constant() || !transmittance.is_constant();
    }
    Bsdf* at(const Hit& hit, Wavelengths& lambda, Arena& arena) const override {
        const TexturePoint at(hit);
        return arena.make<DiffuseTransmissionBsdf>(clamp(reflectance.eval(at, lambda) * scale, 0, 1),
                                                   clamp(transmittance.eval(at, lambda) * scale, 0, 1));
    }
    bool is_uniform() const override { return reflectance.is_constant() && transmittance.is_constant(); }
};

} // namespace

Kind<Material> diffusetransmission_material() {
    return make_kind<Material, DiffuseTransmission>("diffusetransmission");
}

} // namespace alhazen
