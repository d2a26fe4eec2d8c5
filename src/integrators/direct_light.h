/// Next event estimation: one light chosen, one point on it, and what the surface would send to the eye of
/// it.
#pragma once

#include <optional>

#include "integrators/path_context.h"
#include "materials/bsdf.h"

namespace alhazen {

/// Light proposed for a surface, to be counted if shadow_ray is free.
struct DirectLight {
    Spectrum value;        ///< BSDF times cosine times arriving light, over the density of choosing it
    float light_pdf = 0;   ///< that density, per steradian
    float bsdf_pdf = 0;    ///< density with which the BSDF would have chosen the direction
    bool is_delta = false; ///< nothing but light sampling finds this light
    bool is_sky = false;   ///< rays find this light by leaving the scene
    Ray shadow_ray;

    /// The weight beside BSDF sampling.
    float mis_weight() const;
};

/// Whether the integrator finds lights by light sampling alone, or also by directions drawn from BSDFs, both
/// weighed by their densities (then pdf_escaped_beside_bsdf() is that of lights that escaping rays find).
enum class LightSampling { alone, beside_bsdf };

/// Takes three random numbers of the path, whatever comes of them; nullopt when no light would arrive.
std::optional<DirectLight> propose_light(const Hit& hit, const Bsdf& bsdf, const Frame& frame,
                                         PathContext& path, LightSampling sampling = LightSampling::alone);

} // namespace alhazen
