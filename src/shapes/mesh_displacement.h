/// Displacement mapping: a mesh cut so finely that a texture can move its vertices, and moved (Cook 1984,
/// "Shade Trees", section 5; pbrt-v4's plymesh). Picture a plate whose every grain of sand is lifted by its
/// grey value.
#pragma once

#include <string>

#include "base/transform.h"
#include "describe/mesh_file.h"
#include "textures/texture.h"

namespace alhazen {

struct Displacement {
    FloatTexture height;   ///< in object space, along the unit normal
    float edge_length = 1; ///< edges are cut until all are shorter, in world space
    Transform world_from_object;
    std::size_t most_triangles = std::size_t{1} << 27;

    /// Quadrilaterals become triangles; normals that the mesh lacks are made; after moving, all normals are
    /// made anew. The result is "", or says what is wrong (the mesh is then of no use). Vertices that only
    /// coincide, at a seam of uv or a hard edge, may move apart.
    std::string apply(MeshData& mesh) const;
};

/// At each vertex the mean of the unit normals of its triangles, which go round it counterclockwise, at unit
/// length; zero where there is none.
std::vector<Vec3> vertex_normals(const MeshData& triangles);

} // namespace alhazen
