/// Everything that can be seen of a scene as triangles: for what knows nothing else, as grids of distances.
#pragma once

#include <filesystem>
#include <vector>

#include "accel/primitives.h"
#include "describe/scene_description.h"

namespace alhazen {

struct SurfaceOptions {
    /// Along the longest side of the surfaces: curved ones are cut to within a sixteenth of a cell.
    int cells = 128;
    /// That instances may become, 36 bytes each; the structures over them take several times as much.
    std::size_t most_triangles = std::size_t{1} << 25;
};

/// All surfaces of the scene in world space, instances repeated, each turned so that outside stays outside
/// when it is mirrored. Left out are the borders of media (material "interface") and, with a warning that has
/// their place, kinds that cannot be cut into triangles (Shape::tessellate). What moves is taken where it is
/// when the shutter opens; a warning says so. Opacity is not looked at. Film, lights and so on are not built.
/// Does not depend on the number of threads. Throws SceneError with every error of the scene, and when there
/// are no surfaces or more than most_triangles.
std::vector<Corners> surface_triangles(SceneDescription description, const SurfaceOptions& options,
                                       Messages& messages);

/// The same of a mesh file (PLY), as it stands there; quadrilaterals are split. Throws std::runtime_error
/// without the file's name.
std::vector<Corners> mesh_triangles(const std::filesystem::path& file);

} // namespace alhazen
