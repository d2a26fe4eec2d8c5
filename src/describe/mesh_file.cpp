#include "describe/mesh_file.h"

namespace alhazen {

void split_quads(MeshData& mesh) {
    std::size_t triangles = mesh.triangle_count();
    std::size_t quads = mesh.quad_count();
    mesh.indices.reserve((triangles + 2 * quads) * 3);
    for (std::size_t i = 0; i < quads; ++i) {
        const int* q = mesh.quad_indices.data() + 4 * i;
        // The patch order 0 1 / 2 3 goes round the edge as 0 1 3 2.
        mesh.indices.insert(mesh.indices.end(), {q[0], q[1], q[3], q[0], q[3], q[2]});
    }
    if (!mesh.face_indices.empty()) {
        std::vector<int> faces(mesh.face_indices.begin(),
                               mesh.face_indices.begin() + static_cast<std::ptrdiff_t>(triangles));
        faces.reserve(triangles + 2 * quads);
        for (std::size_t i = 0; i < quads; ++i)
            faces.insert(faces.end(), 2, mesh.face_indices[triangles + i]);
        mesh.face_indices = std::move(faces);
    }
    mesh.quad_indices.clear();
}

} // namespace alhazen
