/// What is left of a triangle in front of the camera and not too far beside the picture.
#pragma once

#include <array>
#include <cstddef>

#include "base/vec.h"

namespace alhazen {

/// A corner before the division by w: Projection's x w, y w (in the viewport), depth and w.
struct ClipCorner {
    double x, y, depth, w;
};

/// A convex polygon.
struct ClipPolygon {
    /// Each of the five planes adds one corner, and rounding may add a few.
    static constexpr std::size_t max_corners = 14;
    std::array<ClipCorner, max_corners> corners;
    std::size_t count = 0;
};

/// Cuts the triangle at depth = near_depth and at the guard band's borders (Sutherland and Hodgman 1974). A
/// new corner depends on the two ends of its edge only, so that neighbours keep sharing their edge.
ClipPolygon clip_triangle(const std::array<ClipCorner, 3>& triangle, double near_depth);

} // namespace alhazen
