#include "raster/setup.h"

#include "raster/setup_text.h"

namespace alhazen {

RasterCorner make_corner(double x, double y, double q) {
    // Made positive, so that cutting the fraction off rounds down; std::floor is a call where SSE 4.1 is not
    // assumed.
    constexpr std::int32_t shift = 1 << 27;
    auto fixed = [](double v) {
        return static_cast<std::int32_t>(v * raster_subpixels + (shift + 0.5)) - shift;
    };
    return {x, y, q, fixed(x), fixed(y)};
}

bool misses_tile(const RasterTriangle& triangle, const RasterCorner& a, const RasterCorner& b,
                 const RasterCorner& c, int tx, int ty) {
    if (triangle.x1 - triangle.x0 <= raster_tile && triangle.y1 - triangle.y0 <= raster_tile) return false;
    Edges edges;
    return !find_edges(a, b, c, edges) || misses(edges, tx * raster_tile, ty * raster_tile, raster_tile);
}

} // namespace alhazen
