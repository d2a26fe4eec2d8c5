/// Steps of paths through participating media: along a ray until something happens, and on to a light.
#pragma once

#include <optional>

#include "integrators/direct_light.h"
#include "integrators/lane_weights.h"
#include "integrators/path_context.h"

namespace alhazen {

/// How a ray's way through a medium ended.
struct MediumCrossing {
    enum class End { passed, scattered, absorbed };
    End end = End::passed;
    Spectrum emitted = 0; ///< by the medium on the way, weighed
    Vec3 p, wo;           ///< where it was scattered, and unit vector back along the ray
};

/// Follows the ray through the medium up to ray.tmax. counts_emission: whether what glows is seen.
MediumCrossing cross_medium(const Medium& medium, const Ray& ray, bool counts_emission, LaneWeights& weights,
                            PathContext& path);

/// Next event estimation at a point of a medium; takes three random numbers.
std::optional<DirectLight> propose_light_in_medium(const MediumCrossing& at, const Medium& medium, float time,
                                                   PathContext& path);

/// Weights at the light's end of a shadow ray that begins in the medium: through media and their borders,
/// black where something stands in between.
Task<LaneWeights> shadow_weights(Ray ray, const Medium* medium, LaneWeights weights, PathContext& path);

} // namespace alhazen
