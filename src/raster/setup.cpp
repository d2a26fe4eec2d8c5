#include "raster/setup.h"

#include "raster/setup_text.h"

namespace alhazen {

namespace {

/// The pixels between subpixels lo and hi, and in the range, that hold a sample.
void pixel_range(std::int32_t lo, std::int32_t hi, Vec2i range, bool single_sample, std::int16_t& first,
                 std::int16_t& end) {
    constexpr std::int32_t half = raster_subpixels / 2;
    if (single_sample) {
        lo += half - 1; // the first middle at or after lo
        hi -= half;     // the last at or before hi
    }
    // Shifts round down.
    first = static_cast<std::int16_t>(std::clamp(lo >> raster_subpixel_bits, range.x, range.y));
    end = static_cast<std::int16_t>(std::clamp((hi >> raster_subpixel_bits) + 1, range.x, range.y));
}

/// Whether the pixel's middle is inside.
bool covers(const RasterCorner& a, const RasterCorner& b, const RasterCorner& c, int x, int y) {
    Edges edges;
    if (!find_edges(a, b, c, edges)) return false;
    const std::int64_t sx = std::int64_t{x} * raster_subpixels + raster_subpixels / 2;
    const std::int64_t sy = std::int64_t{y} * raster_subpixels + raster_subpixels / 2;
    bool inside = true;
    for (int e = 0; e < 3; ++e) inside &= edges.a[e] * sx + edges.b[e] * sy + edges.c[e] >= 0;
    return inside;
}

} // namespace

RasterCorner make_corner(double x, double y, double q) {
    // Made positive, so that cutting the fraction off rounds down; std::floor is a call where SSE 4.1 is not
    // assumed.
    constexpr std::int32_t shift = 1 << 27;
    auto fixed = [](double v) {
        return static_cast<std::int32_t>(v * raster_subpixels + (shift + 0.5)) - shift;
    };
    return {x, y, q, fixed(x), fixed(y)};
}

std::optional<RasterTriangle> set_up_triangle(const RasterCorner& a, const RasterCorner& b,
                                              const RasterCorner& c, const Rect2i& part, bool single_sample) {
    const auto [x_lo, x_hi] = std::minmax({a.fixed_x, b.fixed_x, c.fixed_x});
    const auto [y_lo, y_hi] = std::minmax({a.fixed_y, b.fixed_y, c.fixed_y});
    RasterTriangle t{};
    pixel_range(x_lo, x_hi, {part.lo.x, part.hi.x}, single_sample, t.x0, t.x1);
    pixel_range(y_lo, y_hi, {part.lo.y, part.hi.y}, single_sample, t.y0, t.y1);
    if (t.x0 >= t.x1 || t.y0 >= t.y1) return std::nullopt;
    // Half of the triangles as small as a pixel miss its only sample.
    const bool is_one_sample = single_sample && t.x1 - t.x0 == 1 && t.y1 - t.y0 == 1;
    if (is_one_sample && !covers(a, b, c, t.x0, t.y0)) return std::nullopt;
    t.q_max = static_cast<float>(std::max({a.q, b.q, c.q}));
    t.plane = RasterTriangle::no_plane;
    return t;
}

bool misses_tile(const RasterTriangle& triangle, const RasterCorner& a, const RasterCorner& b,
                 const RasterCorner& c, int tx, int ty) {
    if (triangle.x1 - triangle.x0 <= raster_tile && triangle.y1 - triangle.y0 <= raster_tile) return false;
    Edges edges;
    return !find_edges(a, b, c, edges) || misses(edges, tx * raster_tile, ty * raster_tile, raster_tile);
}

} // namespace alhazen
