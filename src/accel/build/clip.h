/// The part of a triangle inside a box, for trees whose cells cut primitives: the triangle's polygon is cut
/// by one plane of the box after the other (Sutherland and Hodgman 1974, "Reentrant Polygon Clipping").
#pragma once

#include "accel/primitives.h"

namespace alhazen {

/// The box of the part of a triangle inside a box; empty if it stays outside. Computed in double and rounded
/// outwards, but not beyond the box.
Bounds3 clipped_bounds(const Corners& triangle, const Bounds3& box);

} // namespace alhazen
