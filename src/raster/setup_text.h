/// The edges of a triangle, as text: what the kernels and the sorting into tiles share, compiled for the
/// instruction set of whoever includes it.
#pragma once

#include "raster/kernel.h"

namespace {

#define ALHAZEN_INLINE __attribute__((always_inline)) inline

/// Three functions a x + b y + c, x and y in subpixels, not negative at the samples that are inside; c counts
/// the top-left rule in.
struct Edges {
    std::int32_t a[3], b[3];
    std::int64_t c[3];
};

/// Not negative to the right of the way from p to q (y downwards), which is the inside of triangles that are
/// clockwise on the film.
ALHAZEN_INLINE void find_edge(const alhazen::RasterCorner& p, const alhazen::RasterCorner& q, Edges& edges,
                              int i) {
    const std::int32_t a = p.fixed_y - q.fixed_y, b = q.fixed_x - p.fixed_x;
    // On a left edge the inside is to the right; on a top edge, below.
    const bool is_top_left = a > 0 || (a == 0 && b > 0);
    edges.a[i] = a;
    edges.b[i] = b;
    edges.c[i] = -(std::int64_t{a} * p.fixed_x + std::int64_t{b} * p.fixed_y) - !is_top_left;
}

/// False for triangles without area.
ALHAZEN_INLINE bool find_edges(const alhazen::RasterCorner& p, const alhazen::RasterCorner& q,
                               const alhazen::RasterCorner& r, Edges& edges) {
    const std::int64_t area = std::int64_t{q.fixed_x - p.fixed_x} * (r.fixed_y - p.fixed_y) -
                              std::int64_t{r.fixed_x - p.fixed_x} * (q.fixed_y - p.fixed_y);
    if (area == 0) return false;
    const alhazen::RasterCorner &second = area > 0 ? q : r, &third = area > 0 ? r : q;
    find_edge(p, second, edges, 0);
    find_edge(second, third, edges, 1);
    find_edge(third, p, edges, 2);
    return true;
}

/// Whether the square from x, y (pixels) is outside of one edge, by its corner farthest inside.
ALHAZEN_INLINE bool misses(const Edges& edges, std::int32_t x, std::int32_t y, std::int32_t side) {
    bool miss = false;
    for (int e = 0; e < 3; ++e) {
        const std::int64_t cx = std::int64_t{x + (edges.a[e] > 0 ? side : 0)} * alhazen::raster_subpixels;
        const std::int64_t cy = std::int64_t{y + (edges.b[e] > 0 ? side : 0)} * alhazen::raster_subpixels;
        miss |= edges.a[e] * cx + edges.b[e] * cy + edges.c[e] < 0;
    }
    return miss;
}

} // namespace
