/// Metal: light is reflected with the colour of the complex Fresnel equations, by a mirror or by microfacets
/// (Torrance and Sparrow 1967; Pharr et al. 2023, sections 9.4 and 9.6).
#pragma once

#include "materials/bsdf.h"
#include "materials/fresnel.h"
#include "materials/microfacet.h"

namespace alhazen {

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

} // namespace alhazen
