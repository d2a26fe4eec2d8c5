/// From a triangle's corners on the film to what the coverage kernel draws.
///
/// Corners are rounded to a 4096th of a pixel, and from there on coverage is exact: a sample on an edge that
/// two triangles share belongs to one of them (the top-left rule: to the triangle on whose left edge it lies,
/// or on whose horizontal top edge), so that a closed surface is drawn without gaps and without drawing a
/// sample twice.
#pragma once

#include <array>
#include <optional>

#include "base/bounds.h"
#include "raster/kernel.h"

namespace alhazen {

/// Coordinates in the viewport may lie this far outside (pixels): guard_low <= x, y <= guard_high. What
/// reaches farther must be clipped.
inline constexpr double guard_low = -6144, guard_high = 10240;
/// Pixels on a side of a viewport.
inline constexpr int viewport_size = 4096;

/// A corner: where it is in the viewport (pixels), and how near.
struct FilmCorner {
    double x, y, q;
};

/// How nearness grows over the film.
struct NearnessPlane {
    double q0, qx, qy; ///< at the viewport's corner, and over a pixel
};

/// A corner in subpixels.
struct FixedPoint {
    std::int32_t x, y;
};
FixedPoint to_fixed(double x, double y);

/// The plane through three corners; level when they lie on one line.
NearnessPlane plane_through(const std::array<FilmCorner, 3>& corners);

/// nullopt for triangles that cover no place where a sample may be, in a part of the viewport (pixels).
/// plane: nullptr for the one through the corners. single_sample: whether there is one sample a pixel, in the
/// middle, or several, which may be anywhere. draw and primitive are left at zero.
std::optional<RasterTriangle> set_up_triangle(const std::array<FilmCorner, 3>& corners,
                                              const NearnessPlane* plane, const Rect2i& part,
                                              bool single_sample);

} // namespace alhazen
