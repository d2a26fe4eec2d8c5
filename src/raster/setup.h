/// From a triangle's corners on the film to what the coverage kernel draws.
///
/// Corners are rounded to a 4096th of a pixel, and from there on coverage is exact: a sample on an edge that
/// two triangles share belongs to one of them (the top-left rule: to the triangle on whose left edge it lies,
/// or on whose horizontal top edge), so that a closed surface is drawn without gaps and without drawing a
/// sample twice.
#pragma once

#include "base/bounds.h"
#include "raster/kernel.h"

namespace alhazen {

/// Pixels on a side of a viewport.
inline constexpr int viewport_size = 4096;

/// A corner within the guard band.
RasterCorner make_corner(double x, double y, double q);

/// Whether the triangle, which may be large, covers nothing of a tile: tx and ty count tiles.
bool misses_tile(const RasterTriangle& triangle, const RasterCorner& a, const RasterCorner& b,
                 const RasterCorner& c, int tx, int ty);

} // namespace alhazen
