/// Places in media as vertices of paths, treated like points of surfaces: a hit without a material, and a
/// BSDF that is the phase function.
#pragma once

#include "base/hit.h"
#include "integrators/media_walk.h"
#include "materials/bsdf.h"

namespace alhazen {

inline Hit place_in_medium(const MediumCrossing& at, float time) {
    Hit hit;
    hit.p = at.p;
    hit.wo = at.wo;
    hit.time = time;
    return hit;
}
inline bool is_on_surface(const Hit& hit) {
    return hit.material != nullptr;
}
/// By what areas at the hit are foreshortened along w; a place in a medium has none.
inline float cosine_at(const Hit& hit, Vec3 w) {
    return is_on_surface(hit) ? abs_dot(hit.ng, w) : 1;
}

/// Directions may be in any frame; no cosine counts.
struct PhaseBsdf final : Bsdf {
    HenyeyGreenstein phase;

    explicit PhaseBsdf(const HenyeyGreenstein& phase_) : phase(phase_) {}

    Scatter eval(Vec3 wo, Vec3 wi, TransportMode) const override {
        const float p = phase.eval(wo, wi);
        return {p, p, p};
    }
    std::optional<BsdfSample> sample(Vec3 wo, float, Vec2 u2, TransportMode) const override {
        const PhaseSample next = phase.sample(wo, u2);
        return BsdfSample{next.wi, next.pdf, next.pdf, next.pdf, lobes(), 1};
    }
    Lobes lobes() const override { return Lobes::reflection | Lobes::diffuse; }
};

} // namespace alhazen
