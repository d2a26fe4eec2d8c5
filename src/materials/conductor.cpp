/// Metals: light is reflected with the colour of the complex Fresnel equations, by a mirror or by microfacets
/// (Torrance and Sparrow 1967; Pharr et al. 2023, sections 9.4 and 9.6).
#include "materials/fresnel.h"
#include "materials/roughness.h"

namespace alhazen {

namespace {

struct ConductorBsdf final : Bsdf {
    TrowbridgeReitz facets;
    Spectrum eta, k;

    ConductorBsdf(TrowbridgeReitz facets_, Spectrum eta_, Spectrum k_) : facets(facets_), eta(eta_), k(k_) {}

    Scatter eval(Vec3 wo, Vec3 wi, TransportMode) const override {
        if (facets.is_smooth() || !same_hemisphere(wo, wi)) return {};
        Vec3 wm = normalize(wo + wi);
        float density = facets.density(wm);
        float cos_o = abs_cos_theta(wo), cos_i = abs_cos_theta(wi);
        Spectrum fresnel = fresnel_conductor(abs_dot(wo, wm), eta, k);
        // The half vector's solid angle is 1 / (4 |wo . wm|) of wi's, which cancels the cosine in the density
        // of the visible normals.
        return {fresnel * (density * facets.visible(wo, wi) / (4 * cos_o)),
                density * facets.visible(wo) / (4 * cos_o), density * facets.visible(wi) / (4 * cos_i)};
    }

    std::optional<BsdfSample> sample(Vec3 wo, float, Vec2 u2, TransportMode mode) const override {
        if (wo.z == 0) return std::nullopt;
        if (facets.is_smooth()) {
            Spectrum fresnel = fresnel_conductor(abs_cos_theta(wo), eta, k);
            return BsdfSample{{-wo.x, -wo.y, wo.z}, fresnel, 1, 1, lobes(), 1};
        }
        Vec3 wi = normalize(reflect(wo, facets.sample(wo, u2)));
        Scatter s = eval(wo, wi, mode);
        // Light that would go on to another facet is lost.
        if (!(s.pdf > 0)) return std::nullopt;
        return BsdfSample{wi, s.f, s.pdf, s.pdf_reverse, lobes(), 1};
    }

    Lobes lobes() const override {
        return Lobes::reflection | (facets.is_smooth() ? Lobes::specular : Lobes::glossy);
    }
    void regularize() override { facets.regularize(); }
    WhittedTerms whitted(Vec3 wo) const override {
        if (!facets.is_smooth()) return {};
        return {.mirror = fresnel_conductor(abs_cos_theta(wo), eta, k)};
    }
};

UnboundedTexture copper(std::string_view part) {
    const SpectralCurve* curve = named_spectrum("metal-Cu-" + std::string(part));
    return UnboundedTexture(SpectrumValue::curve(*curve, SpectrumRole::unbounded));
}

struct Conductor final : RoughMaterial {
    std::optional<UnboundedTexture> eta, k;
    std::optional<AlbedoTexture> reflectance;

    static void describe(Fields<Conductor>& f) {
        f.about("Metal. Its colour comes from its index of refraction eta - i k, or from the reflectance at "
                "normal "
                "incidence; rough metal is a landscape of microfacets.");
        f.field("eta", &Conductor::eta, "index of refraction").otherwise("\"metal-Cu-eta\"");
        f.field("k", &Conductor::k, "absorption coefficient").otherwise("\"metal-Cu-k\"");
        f.field("reflectance", &Conductor::reflectance,
                "fraction of light reflected at normal incidence, instead of eta and k")
            .in(0, 1);
        describe_roughness(f);
        f.example("copper mirror", {});
        f.example("rough gold", {make_spectrum("eta", "metal-Au-eta"), make_spectrum("k", "metal-Au-k"),
                                 make_float("roughness", 0.3f)});
        f.example("brushed aluminium",
                  {make_spectrum("eta", "metal-Al-eta"), make_spectrum("k", "metal-Al-k"),
                   make_float("uroughness", 0.04f), make_float("vroughness", 0.25f)});
        f.example("blue foil", {make_rgb("reflectance", 0.2f, 0.3f, 0.8f), make_float("roughness", 0.5f),
                                make_bool("remaproughness", false)});
        f.example("perfect mirror", {make_float("reflectance", 1)});
    }
    void finish(const Node& node, BuildContext& context) {
        if (reflectance && (eta || k)) {
            context.messages.add_error(
                node.place, "material \"conductor\" has both \"reflectance\" and \"eta\" or \"k\"; only one "
                            "can be given");
            return;
        }
        if (!reflectance && !eta) eta = copper("eta");
        if (!reflectance && !k) k = copper("k");
    }

    bool needs_parameters() const override {
        auto varies = [](const auto& texture) { return texture && !texture->is_constant(); };
        return RoughMaterial::needs_parameters() || varies(eta) || varies(k) || varies(reflectance);
    }
    Bsdf* at(const Hit& hit, Wavelengths& lambda, Arena& arena) const override {
        TexturePoint at(hit);
        TrowbridgeReitz facets = microfacets(at);
        if (!reflectance)
            return arena.make<ConductorBsdf>(facets, eta->eval(at, lambda), k->eval(at, lambda));
        // With eta = 1 the reflectance at normal incidence is k^2 / (k^2 + 4), solved for k (as pbrt-v4). It
        // must stay below 1, where k is infinite.
        Spectrum r = clamp(reflectance->eval(at, lambda), 0, 0.9999f);
        return arena.make<ConductorBsdf>(facets, Spectrum(1), 2 * sqrt(r) / sqrt(1 - r));
    }
};

} // namespace

Kind<Material> conductor_material() {
    return make_kind<Material, Conductor>("conductor");
}

} // namespace alhazen
