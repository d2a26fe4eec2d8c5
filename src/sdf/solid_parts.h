/// Which triangles of a mesh enclose something, and which are mere sheets: the ground that bodies stand on, a
/// wall behind them.
#pragma once

#include <span>
#include <vector>

#include "accel/primitives.h"

namespace alhazen {

struct MeshParts {
    std::vector<Corners> solid, sheets;
};
/// Triangles that hang together, by corners at the same place, are one part. It is a sheet when its area
/// vectors add up to more than 0.6 of its area: to 1 where it is flat, to 0 where it is closed, to 0.5 for
/// half a ball. Sheets have no inside, but seen from a body in front of them would fill half of all
/// directions, and so outweigh it. is_one_body: sheets that together enclose something (whose area vectors
/// add up to less than 0.1 of their area) are faces of it that do not quite meet, and solid.
MeshParts mesh_parts(std::span<const Corners> triangles, bool is_one_body);

} // namespace alhazen
