/// The walk of the path tracer, for integrators that are one where nothing fills space.
#pragma once

#include "integrators/path_context.h"

namespace alhazen {

struct PathRules {
    int maxdepth = 5;
    bool regularize = false; ///< widen narrow lobes after the first rough bounce
};

/// The radiance arriving against the ray, from surfaces: one light and one direction of the BSDF are sampled
/// at each (see path.cpp).
Task<Spectrum> trace_path(PathRules rules, Ray ray, PathContext& path);

} // namespace alhazen
