/// Meshes in the Stanford polygon format (Turk 1994), ascii and binary of either byte order.
#pragma once

#include <filesystem>
#include <string_view>

#include "describe/mesh_file.h"

namespace alhazen {

/// Reads the vertices (x y z, and when there nx ny nz and u v | s t | texture_u texture_v | texture_s
/// texture_t) and the faces (vertex_indices | vertex_index, and face_indices when there) of a PLY file, which
/// may be gzip-compressed; other elements and properties are read past. Faces with three vertices become
/// triangles, with four quadrilaterals. Those of any other number are left out and counted: pbrt leaves them
/// out too, which makes holes, and a fan is wrong for a concave polygon. Throws std::runtime_error with the
/// line or byte.
MeshData read_ply(const std::filesystem::path& file);

/// The same from memory.
MeshData parse_ply(std::string_view bytes);

} // namespace alhazen
