/// Meshes that scenes keep in files of their own: what such a file holds, and how shapes ask for one without
/// knowing any file format.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/vec.h"

namespace alhazen {

/// Triangles and quadrilaterals over shared vertices, in object space.
struct MeshData {
    std::vector<Vec3> P;      ///< positions, finite
    std::vector<Vec3> N;      ///< normals, one a vertex and as the file gives them, or none
    std::vector<Vec2> uv;     ///< one a vertex, or none
    std::vector<int> indices; ///< three a triangle, each a valid index into P
    /// Four a quadrilateral, in the order of a bilinear patch: corners (0,0), (1,0), (0,1), (1,1). Going
    /// round the edge is 0, 1, 3, 2.
    std::vector<int> quad_indices;
    /// The file's own number of each face, triangles first and then quadrilaterals in the order of the arrays
    /// above; or none.
    std::vector<int> face_indices;

    /// Faces of the file with fewer than three corners or more than four, which are not in the arrays, and
    /// the words for the first of them.
    std::size_t odd_faces = 0;
    std::string first_odd_face;

    std::size_t triangle_count() const { return indices.size() / 3; }
    std::size_t quad_count() const { return quad_indices.size() / 4; }
};

/// Cuts each quadrilateral a b c d (in order round the edge) into the triangles a b c and a c d, and adds
/// those to the triangles; face_indices follow.
void split_quads(MeshData& mesh);

/// Reads a mesh file. Throws std::runtime_error saying what is wrong and at which line or byte, without the
/// file's name.
using MeshReader = std::function<MeshData(const std::filesystem::path&)>;

} // namespace alhazen
