/// Triangles along the surface of a signed distance field: what areas are measured and points chosen on.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "sdf/placed_sdf.h"

namespace alhazen {

using SdfTriangle = std::array<Vec3d, 3>;

/// Marching tetrahedra (Doi and Koide 1991) over the cells of a grid of 2^levels cells along the field's
/// longest side that the surface may pass through, with the corners moved onto the surface. Sharp edges are
/// cut off by up to a cell. The field must be bounded. Does not depend on the number of threads.
std::vector<SdfTriangle> tessellate(const PlacedSdf& field, int levels);

/// Moves a point near the surface onto it.
using MoveToSurface = std::function<Vec3d(Vec3d)>;

/// One cubic cell of that: f are the field's values at its corners, x fastest.
void march_cell(Vec3d lo, double size, const std::array<double, 8>& f, const MoveToSurface& move,
                std::vector<SdfTriangle>& out);

/// p moved along the field's gradient onto its surface, which is near: Newton's method.
Vec3d move_to_surface(const PlacedSdf& field, Vec3d p, double reach);

} // namespace alhazen
