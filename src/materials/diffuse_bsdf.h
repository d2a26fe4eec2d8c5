/// Lambert's surface (1760): reflected light does not depend on the direction of view.
#pragma once

#include "materials/bsdf.h"
#include "math/warp.h"

namespace alhazen {

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

} // namespace alhazen
