/// Light beneath surfaces: a path that is refracted into scattering matter goes on from where it leaves.
#pragma once

#include <optional>

#include "integrators/path_context.h"
#include "materials/bssrdf.h"

namespace alhazen {

/// Where a path leaves matter again.
struct SubsurfaceExit {
    Hit hit;             ///< seen along its shading normal
    Spectrum weight = 0; ///< light that leaves there, over the density of choosing it
};

/// What a path enters that a BSDF sends on from the hit; nullptr where it does not, or nothing scatters
/// there.
const Bssrdf* matter_entered(const Hit& hit, const BsdfSample& next, PathContext& path);

/// One place, of those where light may leave that has entered at the hit: on the same material, which may be
/// of another shape. Takes four random numbers.
Task<std::optional<SubsurfaceExit>> leave_matter(const Hit& hit, const Bssrdf& matter, PathContext& path);

} // namespace alhazen
