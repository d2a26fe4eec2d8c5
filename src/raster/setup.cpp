#include "raster/setup.h"

#include <cmath>

namespace alhazen {

namespace {

struct Edge {
    std::int32_t a, b;
    std::int64_t c;
};

/// Not negative to the right of the way from p to q (y downwards), which is the inside of triangles that are
/// clockwise on the film.
Edge edge_between(FixedPoint p, FixedPoint q) {
    Edge e;
    e.a = p.y - q.y;
    e.b = q.x - p.x;
    e.c = -(std::int64_t{e.a} * p.x + std::int64_t{e.b} * p.y);
    // On a left edge the inside is to the right; on a top edge, below.
    const bool is_top_left = e.a > 0 || (e.a == 0 && e.b > 0);
    if (!is_top_left) e.c -= 1;
    return e;
}

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
bool covers(const RasterTriangle& t, int x, int y) {
    const std::int64_t sx = std::int64_t{x} * raster_subpixels + raster_subpixels / 2;
    const std::int64_t sy = std::int64_t{y} * raster_subpixels + raster_subpixels / 2;
    bool inside = true;
    for (std::size_t e = 0; e < 3; ++e) inside &= t.a[e] * sx + t.b[e] * sy + t.c[e] >= 0;
    return inside;
}

} // namespace

FixedPoint to_fixed(double x, double y) {
    // Made positive, so that cutting the fraction off rounds down; std::floor is a call where SSE 4.1 is not
    // assumed.
    constexpr std::int32_t shift = 1 << 27;
    auto fixed = [](double v) {
        return static_cast<std::int32_t>(v * raster_subpixels + (shift + 0.5)) - shift;
    };
    return {fixed(x), fixed(y)};
}

NearnessPlane plane_through(const std::array<FilmCorner, 3>& corners) {
    const auto& [a, b, c] = corners;
    const double x1 = b.x - a.x, y1 = b.y - a.y, x2 = c.x - a.x, y2 = c.y - a.y;
    const double area = x1 * y2 - x2 * y1;
    const double q1 = b.q - a.q, q2 = c.q - a.q;
    if (!(std::abs(area) > 0)) return {a.q, 0, 0};
    const double qx = (q1 * y2 - q2 * y1) / area, qy = (q2 * x1 - q1 * x2) / area;
    return {a.q - qx * a.x - qy * a.y, qx, qy};
}

std::optional<RasterTriangle> set_up_triangle(const std::array<FilmCorner, 3>& corners,
                                              const NearnessPlane* given, const Rect2i& part,
                                              bool single_sample) {
    std::array<FixedPoint, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = to_fixed(corners[i].x, corners[i].y);
    const auto [x_lo, x_hi] = std::minmax({p[0].x, p[1].x, p[2].x});
    const auto [y_lo, y_hi] = std::minmax({p[0].y, p[1].y, p[2].y});
    RasterTriangle t{};
    pixel_range(x_lo, x_hi, {part.lo.x, part.hi.x}, single_sample, t.x0, t.x1);
    pixel_range(y_lo, y_hi, {part.lo.y, part.hi.y}, single_sample, t.y0, t.y1);
    if (t.x0 >= t.x1 || t.y0 >= t.y1) return std::nullopt;
    const std::int64_t area =
        std::int64_t{p[1].x - p[0].x} * (p[2].y - p[0].y) - std::int64_t{p[2].x - p[0].x} * (p[1].y - p[0].y);
    if (area == 0) return std::nullopt;
    if (area < 0) std::swap(p[1], p[2]);
    for (std::size_t i = 0; i < 3; ++i) {
        const Edge e = edge_between(p[i], p[(i + 1) % 3]);
        t.a[i] = e.a;
        t.b[i] = e.b;
        t.c[i] = e.c;
    }
    // Half of the triangles as small as a pixel miss its only sample.
    const bool is_one_sample = single_sample && t.x1 - t.x0 == 1 && t.y1 - t.y0 == 1;
    if (is_one_sample && !covers(t, t.x0, t.y0)) return std::nullopt;
    const NearnessPlane plane = given ? *given : plane_through(corners);
    t.q0 = plane.q0;
    t.qx = plane.qx;
    t.qy = plane.qy;
    const auto [q_lo, q_hi] = std::minmax({corners[0].q, corners[1].q, corners[2].q});
    t.q_min = static_cast<float>(q_lo);
    t.q_max = static_cast<float>(q_hi);
    return t;
}

} // namespace alhazen
