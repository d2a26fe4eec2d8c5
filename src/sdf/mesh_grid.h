/// From a mesh to a grid of signed distances.
#pragma once

#include <functional>

#include "describe/grid_file.h"
#include "sdf/mesh_distance.h"

namespace alhazen {

struct MeshGridOptions {
    int resolution = 128; ///< cells along the longest side of the mesh
    int band = 3;         ///< cells around the surface that are sampled, and margin around the mesh
    bool is_full = false; ///< everywhere, rather than in the band only
    /// The triangles are one body's; else those of a scene (see mesh_parts).
    bool is_one_body = true;
};

/// Distances at the points of a grid of cubic cells around the triangles: from what is solid, negative inside
/// by the generalised winding number; of sheets, which have no inside, from the surface of a wall one and a
/// half cells thick. progress is called with the fraction done, from one thread at a time; when it returns
/// false, sampling stops and the result is incomplete. Does not depend on the number of threads. Throws
/// std::runtime_error when the mesh has no extent.
GridData sample_mesh(const std::vector<Corners>& triangles, const MeshGridOptions& options,
                     const std::function<bool(double)>& progress);

} // namespace alhazen
