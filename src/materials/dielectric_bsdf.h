/// A border between two clear media, smooth or of microfacets (Walter et al. 2007; Pharr et al. 2023,
/// sections 9.5 and 9.7): by itself glass, over another surface its coating.
#pragma once

#include "materials/bsdf.h"
#include "materials/fresnel.h"
#include "materials/microfacet.h"

namespace alhazen {

/// Which part of a border's scattering is wanted.
enum class Sides {
    both,
    same,   ///< reflection
    across, ///< transmission
};

struct DielectricBsdf final : Bsdf {
    TrowbridgeReitz facets;
    float eta; ///< index below over above

    DielectricBsdf(TrowbridgeReitz facets_, float eta_) : facets(facets_), eta(eta_) {}

    // Equal indices bend nothing, and have no half vector.
    bool is_specular() const { return eta == 1 || facets.is_smooth(); }

    Scatter eval(Vec3 wo, Vec3 wi, TransportMode mode) const override {
        return eval(wo, wi, mode, Sides::both);
    }
    std::optional<BsdfSample> sample(Vec3 wo, float u, Vec2 u2, TransportMode mode) const override {
        return sample(wo, u, u2, mode, Sides::both);
    }

    /// The same when only some sides are wanted: the densities are of sampling those alone.
    Scatter eval(Vec3 wo, Vec3 wi, TransportMode mode, Sides sides) const {
        if (is_specular() || wo.z == 0 || wi.z == 0) return {};
        if (same_hemisphere(wo, wi))
            return sides == Sides::across ? Scatter{} : eval_reflection(wo, wi, sides);
        return sides == Sides::same ? Scatter{} : eval_transmission(wo, wi, mode, sides);
    }
    std::optional<BsdfSample> sample(Vec3 wo, float u, Vec2 u2, TransportMode mode, Sides sides) const {
        if (wo.z == 0) return std::nullopt;
        return is_specular() ? sample_specular(wo, u, mode, sides) : sample_rough(wo, u, u2, mode, sides);
    }

    // Rounding would leave a trace of a mirror where there is nothing.
    float specular_reflection(Vec3 wo) const { return eta == 1 ? 0 : fresnel_dielectric(cos_theta(wo), eta); }

    Lobes lobes() const override {
        Lobes both = eta == 1 ? Lobes::transmission : Lobes::reflection | Lobes::transmission;
        return both | (is_specular() ? Lobes::specular : Lobes::glossy);
    }
    void regularize() override { facets.regularize(); }
    WhittedTerms whitted(Vec3 wo) const override {
        if (!is_specular()) return {};
        float reflected = specular_reflection(wo);
        return {.mirror = reflected, .refract = 1 - reflected, .eta = eta};
    }

  private:
    static float chance_to_reflect(float fresnel, Sides sides) {
        return sides == Sides::both ? fresnel : sides == Sides::same ? 1.0f : 0.0f;
    }

    Scatter eval_reflection(Vec3 wo, Vec3 wi, Sides sides) const {
        Vec3 wm = wo + wi;
        if (length_squared(wm) == 0) return {};
        wm = face_forward(normalize(wm), {0, 0, 1});
        if (sees_back(wm, wo) || sees_back(wm, wi)) return {};
        float fresnel = fresnel_dielectric(dot(wo, wm), eta);
        float density = facets.density(wm) / 4;
        float chance = density * chance_to_reflect(fresnel, sides);
        float cos_o = abs_cos_theta(wo), cos_i = abs_cos_theta(wi);
        return {density * fresnel * facets.visible(wo, wi) / cos_o, chance * facets.visible(wo) / cos_o,
                chance * facets.visible(wi) / cos_i};
    }

    Scatter eval_transmission(Vec3 wo, Vec3 wi, TransportMode mode, Sides sides) const {
        float ratio = wo.z > 0 ? eta : 1 / eta; // index on wi's side over that on wo's
        Vec3 wm = wi * ratio + wo;
        if (length_squared(wm) == 0) return {};
        wm = face_forward(normalize(wm), {0, 0, 1});
        if (sees_back(wm, wo) || sees_back(wm, wi)) return {};
        float dot_o = dot(wo, wm), dot_i = dot(wi, wm);
        float fresnel = fresnel_dielectric(dot_o, eta);
        float cos_o = abs_cos_theta(wo), cos_i = abs_cos_theta(wi);
        // Solid angle of the half vector over that of wi times |wi . wm| is 1 / denominator (Walter et al.
        // 2007, equation 17); the reverse density has the roles swapped.
        float denominator = sqr(dot_i + dot_o / ratio);
        float reverse_denominator = sqr(dot_o + dot_i * ratio);
        float density = facets.density(wm) * std::abs(dot_o * dot_i);
        float f = density * (1 - fresnel) * facets.visible(wo, wi) / (cos_o * denominator);
        if (mode == TransportMode::radiance) f /= sqr(ratio);
        float chance = density * (1 - chance_to_reflect(fresnel, sides));
        return {f, chance * facets.visible(wo) / (cos_o * denominator),
                chance * facets.visible(wi) / (cos_i * reverse_denominator)};
    }

    // Whether w, above or below, would see the facet's wrong side.
    static bool sees_back(Vec3 wm, Vec3 w) { return dot(wm, w) * w.z < 0; }

    std::optional<BsdfSample> sample_specular(Vec3 wo, float u, TransportMode mode, Sides sides) const {
        float reflected = specular_reflection(wo), chance = chance_to_reflect(reflected, sides);
        if (u < chance)
            return BsdfSample{
                {-wo.x, -wo.y, wo.z}, reflected, chance, chance, Lobes::reflection | Lobes::specular, 1};
        auto refraction = refract(wo, {0, 0, 1}, eta);
        if (!refraction || refraction->wt.z == 0) return std::nullopt;
        float transmitted = 1 - reflected;
        float f = mode == TransportMode::radiance ? transmitted / sqr(refraction->eta) : transmitted;
        return BsdfSample{refraction->wt, f, 1 - chance, 1 - chance, Lobes::transmission | Lobes::specular,
                          refraction->eta};
    }

    std::optional<BsdfSample> sample_rough(Vec3 wo, float u, Vec2 u2, TransportMode mode, Sides sides) const {
        Vec3 wm = facets.sample(wo, u2);
        BsdfSample s;
        if (u < chance_to_reflect(fresnel_dielectric(dot(wo, wm), eta), sides)) {
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
        Scatter value = eval(wo, s.wi, mode, sides);
        if (!(value.pdf > 0)) return std::nullopt;
        s.f = value.f;
        s.pdf = value.pdf;
        s.pdf_reverse = value.pdf_reverse;
        return s;
    }
};

} // namespace alhazen
