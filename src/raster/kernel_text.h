/// The coverage kernel, once for every instruction set: triangles against the samples of a tile, eight pixels
/// of a row at a time (edge functions after Pineda 1988; fixed point and blocks as in Abrash 2009; the far
/// side of blocks after Greene, Kass and Miller 1993).
///
/// Samples are whole pixels apart, so that over a block an edge function changes by multiples of the
/// subpixels in a pixel, and is not negative where its whole part (the value shifted right) is not: 64-bit
/// values become exact 32-bit ones, eight to a register.
#pragma once

#include "raster/setup_text.h"

namespace {

using alhazen::RasterBatch;
using alhazen::RasterTarget;
using alhazen::RasterTriangle;

// As many pixels as fit into a register: one row of a block or two.
#if defined(__AVX512F__)
constexpr int lanes = 16;
#else
constexpr int lanes = 8;
#endif
using Floats = float __attribute__((vector_size(4 * lanes)));
using Ints = std::int32_t __attribute__((vector_size(4 * lanes)));

constexpr std::int32_t block = alhazen::raster_block, block_pixels = alhazen::raster_block_pixels;
constexpr std::int32_t subpixels = alhazen::raster_subpixels, subpixel_bits = alhazen::raster_subpixel_bits;
// Within a block an edge function changes by less than this, as triangles have sides below 2^14 pixels.
constexpr std::int64_t far_away = std::int64_t{1} << 30;
// Triangles after which a block's far side is worth finding again.
constexpr std::uint32_t many_changes = 12;

template <class To, class From>
ALHAZEN_INLINE To load(const From* from) {
    To to;
    __builtin_memcpy(&to, from, sizeof to);
    return to;
}
template <class V, class T>
ALHAZEN_INLINE void store(T* to, const V& v) {
    __builtin_memcpy(to, &v, sizeof v);
}

/// A triangle ready to be drawn.
struct ReadyTriangle {
    Edges edges;
    alhazen::RasterPlane plane;
    float q_min, q_max; ///< nearness stays within
};

/// The plane through three corners; level when they lie on one line.
ALHAZEN_INLINE alhazen::RasterPlane plane_through(const alhazen::RasterCorner& a,
                                                  const alhazen::RasterCorner& b,
                                                  const alhazen::RasterCorner& c) {
    const double x1 = b.x - a.x, y1 = b.y - a.y, x2 = c.x - a.x, y2 = c.y - a.y;
    const double area = x1 * y2 - x2 * y1;
    const double q1 = b.q - a.q, q2 = c.q - a.q;
    if (!(area > 0 || area < 0)) return {a.q, 0, 0};
    const double scale = 1 / area;
    const double qx = (q1 * y2 - q2 * y1) * scale, qy = (q2 * x1 - q1 * x2) * scale;
    return {a.q - qx * a.x - qy * a.y, qx, qy};
}

/// False for triangles without area.
ALHAZEN_INLINE bool set_up(const RasterBatch& batch, const RasterTriangle& t, ReadyTriangle& ready) {
    const alhazen::RasterCorner &a = batch.corners[t.corner[0]], &b = batch.corners[t.corner[1]],
                                &c = batch.corners[t.corner[2]];
    if (!find_edges(a, b, c, ready.edges)) return false;
    ready.plane = t.plane == RasterTriangle::no_plane ? plane_through(a, b, c) : batch.planes[t.plane];
    const double least = a.q < b.q ? a.q : b.q;
    ready.q_min = static_cast<float>(least < c.q ? least : c.q);
    ready.q_max = t.q_max;
    return true;
}

/// The edge's whole part at the sample of the block's first pixel.
ALHAZEN_INLINE std::int32_t edge_at(const Edges& edges, int e, std::int64_t x, std::int64_t y) {
    const std::int64_t value = (edges.a[e] * x + edges.b[e] * y + edges.c[e]) >> subpixel_bits;
    return static_cast<std::int32_t>(value < -far_away ? -far_away : value > far_away ? far_away : value);
}

/// Whether it is no larger than a block, so that asking which blocks it misses does not pay.
ALHAZEN_INLINE bool fits_block(const RasterTriangle& t) {
    return t.x1 - t.x0 <= block && t.y1 - t.y0 <= block;
}

ALHAZEN_INLINE void find_far_side(RasterTarget& target, std::int32_t number) {
    const float* nearness =
        target.nearness + static_cast<std::size_t>(number) * target.samples * block_pixels;
    Floats least = load<Floats>(nearness);
    for (std::uint32_t i = lanes; i < target.samples * block_pixels; i += lanes) {
        const Floats other = load<Floats>(nearness + i);
        least = other < least ? other : least;
    }
    float smallest = least[0];
    for (int i = 1; i < lanes; ++i) smallest = least[i] < smallest ? least[i] : smallest;
    target.block_nearness[number] = smallest;
    target.block_changes[number] = 0;
}

/// The triangle's largest nearness over the block.
ALHAZEN_INLINE float nearest_in_block(const ReadyTriangle& t, std::int32_t bx, std::int32_t by) {
    const double x = bx + (t.plane.qx > 0 ? block : 0), y = by + (t.plane.qy > 0 ? block : 0);
    const auto corner = static_cast<float>(t.plane.q0 + t.plane.qx * x + t.plane.qy * y);
    // A little more, since this is rounded otherwise than the samples' nearness.
    const float most = corner + (corner < 0 ? -corner : corner) * 1e-6f;
    return most < t.q_max ? most : t.q_max;
}

/// Lane by lane the pixel's column and row in the vector's first row.
template <class V>
ALHAZEN_INLINE V columns() {
    V v;
    for (int i = 0; i < lanes; ++i) v[i] = static_cast<decltype(v[0] + 0)>(i % block);
    return v;
}
template <class V>
ALHAZEN_INLINE V rows() {
    V v;
    for (int i = 0; i < lanes; ++i) v[i] = static_cast<decltype(v[0] + 0)>(i / block);
    return v;
}

/// Rows first ... end - 1 of one sample of the block, and perhaps more. filter:
/// see RasterBatch.
template <class Filter>
ALHAZEN_INLINE void draw_sample(const ReadyTriangle& t, std::int32_t bx, std::int32_t by, std::int32_t first,
                                std::int32_t end, std::int32_t sample_x, std::int32_t sample_y,
                                float* nearness, std::uint32_t* fragment, std::uint32_t number,
                                const Filter& filter) {
    const std::int64_t x = std::int64_t{bx} * subpixels + sample_x;
    const std::int64_t y = std::int64_t{by} * subpixels + sample_y;
    const Edges& edges = t.edges;
    auto edge = [&](int e) {
        return columns<Ints>() * edges.a[e] + rows<Ints>() * edges.b[e] + edge_at(edges, e, x, y) +
               first * edges.b[e];
    };
    Ints e0 = edge(0), e1 = edge(1), e2 = edge(2);
    constexpr double pixel = 1.0 / subpixels;
    const alhazen::RasterPlane& plane = t.plane;
    const Floats start = columns<Floats>() * static_cast<float>(plane.qx) +
                         static_cast<float>(plane.q0 + plane.qx * (bx + sample_x * pixel) +
                                            plane.qy * (by + sample_y * pixel));
    const auto down = static_cast<float>(plane.qy);
    const Floats q_min = Floats{} + t.q_min, q_max = Floats{} + t.q_max;
    const Ints mine = Ints{} + static_cast<std::int32_t>(number);
    for (std::int32_t row = first; row < end; row += lanes / block) {
        float* place = nearness + row * block;
        const Floats old = load<Floats>(place);
        const Ints before = load<Ints>(fragment + row * block);
        Floats q = start + (rows<Floats>() + static_cast<float>(row)) * down;
        q = q < q_min ? q_min : q;
        q = q > q_max ? q_max : q;
        Ints wins = ((e0 | e1 | e2) >= 0) & ((q > old) | ((q == old) & (mine < before)));
        filter(wins, row);
        store(place, wins ? q : old);
        store(fragment + row * block, wins ? mine : before);
        e0 += edges.b[0] * (lanes / block);
        e1 += edges.b[1] * (lanes / block);
        e2 += edges.b[2] * (lanes / block);
    }
}

ALHAZEN_INLINE void draw_in_block(RasterTarget& target, const RasterBatch& batch, const RasterTriangle& t,
                                  const ReadyTriangle& ready, std::uint32_t number, std::int32_t bx,
                                  std::int32_t by, std::int32_t at) {
    if (!fits_block(t) && (!(nearest_in_block(ready, bx, by) >= target.block_nearness[at]) ||
                           misses(ready.edges, bx, by, block)))
        return;
    const std::int32_t first = t.y0 > by ? (t.y0 - by) / (lanes / block) * (lanes / block) : 0;
    const std::int32_t end = t.y1 < by + block ? t.y1 - by : block;
    for (std::uint32_t s = 0; s < target.samples; ++s) {
        const std::size_t place = (static_cast<std::size_t>(at) * target.samples + s) * block_pixels;
        const auto everywhere = [](Ints&, std::int32_t) {};
        const auto tested = [&](Ints& wins, std::int32_t row) {
            for (int i = 0; i < lanes; ++i)
                if (wins[i] && !batch.accept(batch.owner, number, bx + i % block, by + row + i / block, s))
                    wins[i] = 0;
        };
        if (batch.accept)
            draw_sample(ready, bx, by, first, end, target.sample_x[s], target.sample_y[s],
                        target.nearness + place, target.fragment + place, number, tested);
        else
            draw_sample(ready, bx, by, first, end, target.sample_x[s], target.sample_y[s],
                        target.nearness + place, target.fragment + place, number, everywhere);
    }
    ++target.block_changes[at];
}

ALHAZEN_INLINE void draw_in_tile(RasterTarget& target, const RasterBatch& batch, std::uint32_t local) {
    const RasterTriangle& t = batch.triangles[local];
    constexpr std::int32_t tile = alhazen::raster_tile;
    const std::int32_t x0 = t.x0 > target.x ? (t.x0 - target.x) / block : 0;
    const std::int32_t y0 = t.y0 > target.y ? (t.y0 - target.y) / block : 0;
    const std::int32_t x1 = t.x1 < target.x + tile ? t.x1 - target.x : tile;
    const std::int32_t y1 = t.y1 < target.y + tile ? t.y1 - target.y : tile;
    ReadyTriangle ready;
    bool is_ready = false;
    for (std::int32_t y = y0; y * block < y1; ++y)
        for (std::int32_t x = x0; x * block < x1; ++x) {
            const std::int32_t at = y * alhazen::raster_blocks + x;
            if (!(t.q_max >= target.block_nearness[at])) continue;
            if (target.block_changes[at] >= many_changes) {
                find_far_side(target, at);
                if (!(t.q_max >= target.block_nearness[at])) continue;
            }
            // Most triangles are hidden, and need no edges.
            if (!is_ready && !set_up(batch, t, ready)) return;
            is_ready = true;
            draw_in_block(target, batch, t, ready, batch.first_fragment + local, target.x + x * block,
                          target.y + y * block, at);
        }
}

void draw_batch(RasterTarget& target, const RasterBatch& batch) {
    bool is_hidden = true;
    for (std::int32_t at = 0; at < alhazen::raster_blocks * alhazen::raster_blocks; ++at) {
        if (target.block_changes[at] > 0) find_far_side(target, at);
        is_hidden &= !(batch.q_max >= target.block_nearness[at]);
    }
    if (is_hidden) return;
    for (std::uint32_t i = 0; i < batch.count; ++i) draw_in_tile(target, batch, batch.list[i]);
}

} // namespace
