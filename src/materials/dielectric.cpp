/// Glass, water, plastic: light is reflected and refracted, by a smooth border or by microfacets (Walter et
/// al. 2007; Pharr et al. 2023, sections 9.5 and 9.7).
#include "describe/spectrum_parameter.h"
#include "materials/fresnel.h"
#include "materials/roughness.h"

namespace alhazen {

namespace {

struct DielectricBsdf final : Bsdf {
    TrowbridgeReitz facets;
    float eta; ///< index below over above

    DielectricBsdf(TrowbridgeReitz facets_, float eta_) : facets(facets_), eta(eta_) {}

    // Equal indices bend nothing, and have no half vector.
    bool is_specular() const { return eta == 1 || facets.is_smooth(); }

    Scatter eval(Vec3 wo, Vec3 wi, TransportMode mode) const override {
        if (is_specular() || wo.z == 0 || wi.z == 0) return {};
        return same_hemisphere(wo, wi) ? eval_reflection(wo, wi) : eval_transmission(wo, wi, mode);
    }

    Scatter eval_reflection(Vec3 wo, Vec3 wi) const {
        Vec3 wm = wo + wi;
        if (length_squared(wm) == 0) return {};
        wm = face_forward(normalize(wm), {0, 0, 1});
        if (sees_back(wm, wo) || sees_back(wm, wi)) return {};
        float fresnel = fresnel_dielectric(dot(wo, wm), eta);
        float density = facets.density(wm) * fresnel / 4;
        float cos_o = abs_cos_theta(wo), cos_i = abs_cos_theta(wi);
        return {density * facets.visible(wo, wi) / cos_o, density * facets.visible(wo) / cos_o,
                density * facets.visible(wi) / cos_i};
    }

    Scatter eval_transmission(Vec3 wo, Vec3 wi, TransportMode mode) const {
        float ratio = wo.z > 0 ? eta : 1 / eta; // index on wi's side over that on wo's
        Vec3 wm = wi * ratio + wo;
        if (length_squared(wm) == 0) return {};
        wm = face_forward(normalize(wm), {0, 0, 1});
        if (sees_back(wm, wo) || sees_back(wm, wi)) return {};
        float dot_o = dot(wo, wm), dot_i = dot(wi, wm);
        float transmitted = 1 - fresnel_dielectric(dot_o, eta);
        float cos_o = abs_cos_theta(wo), cos_i = abs_cos_theta(wi);
        // Solid angle of the half vector over that of wi times |wi . wm| is 1 / denominator (Walter et al.
        // 2007, equation 17); the reverse density has the roles swapped.
        float denominator = sqr(dot_i + dot_o / ratio);
        float reverse_denominator = sqr(dot_o + dot_i * ratio);
        float density = facets.density(wm) * transmitted * std::abs(dot_o * dot_i);
        float f = density * facets.visible(wo, wi) / (cos_o * denominator);
        if (mode == TransportMode::radiance) f /= sqr(ratio);
        return {f, density * facets.visible(wo) / (cos_o * denominator),
                density * facets.visible(wi) / (cos_i * reverse_denominator)};
    }

    // Whether w, above or below, would see the facet's wrong side.
    static bool sees_back(Vec3 wm, Vec3 w) { return dot(wm, w) * w.z < 0; }

    std::optional<BsdfSample> sample(Vec3 wo, float u, Vec2 u2, TransportMode mode) const override {
        if (wo.z == 0) return std::nullopt;
        return is_specular() ? sample_specular(wo, u, mode) : sample_rough(wo, u, u2, mode);
    }

    // Rounding would leave a trace of a mirror where there is nothing.
    float specular_reflection(Vec3 wo) const { return eta == 1 ? 0 : fresnel_dielectric(cos_theta(wo), eta); }

    std::optional<BsdfSample> sample_specular(Vec3 wo, float u, TransportMode mode) const {
        float reflected = specular_reflection(wo);
        if (u < reflected)
            return BsdfSample{{-wo.x, -wo.y, wo.z},
                              reflected,
                              reflected,
                              reflected,
                              Lobes::reflection | Lobes::specular,
                              1};
        auto refraction = refract(wo, {0, 0, 1}, eta);
        if (!refraction || refraction->wt.z == 0) return std::nullopt;
        float transmitted = 1 - reflected;
        float f = mode == TransportMode::radiance ? transmitted / sqr(refraction->eta) : transmitted;
        return BsdfSample{refraction->wt, f, transmitted, transmitted, Lobes::transmission | Lobes::specular,
                          refraction->eta};
    }

    std::optional<BsdfSample> sample_rough(Vec3 wo, float u, Vec2 u2, TransportMode mode) const {
        Vec3 wm = facets.sample(wo, u2);
        float reflected = fresnel_dielectric(dot(wo, wm), eta);
        BsdfSample s;
        if (u < reflected) {
            s.wi = normalize(reflect(wo, wm));
            if (!same_hemisphere(wo, s.wi)) return std::nullopt;
            s.lobes = Lobes::reflection | Lobes::glossy;
        } else {
            auto refraction = refract(wo, wm, eta);
            if (!refraction || refraction->wt.z == 0 || same_hemisphere(wo, refraction->wt))
                return std::nullopt;
            s.wi = refraction->wt;
            s.eta = refraction->eta;
            s.lobes = Lobes::transmission | Lobes::glossy;
        }
        Scatter value = eval(wo, s.wi, mode);
        if (!(value.pdf > 0)) return std::nullopt;
        s.f = value.f;
        s.pdf = value.pdf;
        s.pdf_reverse = value.pdf_reverse;
        return s;
    }

    Lobes lobes() const override {
        Lobes sides = eta == 1 ? Lobes::transmission : Lobes::reflection | Lobes::transmission;
        return sides | (is_specular() ? Lobes::specular : Lobes::glossy);
    }
    void regularize() override { facets.regularize(); }
    WhittedTerms whitted(Vec3 wo) const override {
        if (!is_specular()) return {};
        float reflected = specular_reflection(wo);
        return {.mirror = reflected, .refract = 1 - reflected, .eta = eta};
    }
};

struct Dielectric final : RoughMaterial {
    UnboundedSpectrum eta{1.5f};

    static void describe(Fields<Dielectric>& f) {
        f.about(
            "Glass, water and other clear matter: a border that reflects and refracts. A spectrum as index "
            "of refraction disperses white light.");
        f.field("eta", &Dielectric::eta, "index of refraction inside over outside").above(0);
        describe_roughness(f);
        f.example("glass", {});
        f.example("frosted", {make_float("roughness", 0.25f)});
        f.example("flint prism", {make_spectrum("eta", "glass-SF11")});
        f.example("rolled water", {make_float("eta", 1.33f), make_float("uroughness", 0.5f),
                                   make_float("vroughness", 0.2f), make_bool("remaproughness", false)});
        f.example("bubble", {make_float("eta", 0.75f), make_float("roughness", 0.1f)});
        f.example("nothing", {make_float("eta", 1), make_float("roughness", 0.1f)});
    }

    Bsdf* at(const Hit& hit, Wavelengths& lambda, Arena& arena) const override {
        float index = lambda.hero(eta.eval(lambda));
        if (!eta.value.is_constant()) lambda.terminate_secondary();
        // Outside the range of a measured spectrum it says nothing.
        if (!(index > 0)) index = 1;
        return arena.make<DielectricBsdf>(microfacets(TexturePoint(hit)), index);
    }
};

} // namespace

Kind<Material> dielectric_material() {
    return make_kind<Material, Dielectric>("dielectric");
}

} // namespace alhazen
