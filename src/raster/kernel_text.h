/// The coverage kernel, once for every instruction set: triangles against the samples of a tile, eight pixels
/// of a row at a time (edge functions after Pineda 1988; fixed point and blocks as in Abrash 2009; the far
/// side of blocks after Greene, Kass and Miller 1993).
///
/// Samples are whole pixels apart, so that over a block an edge function changes by multiples of the
/// subpixels in a pixel, and is not negative where its whole part (the value shifted right) is not: 64-bit
/// values become exact 32-bit ones, eight to a register.
#pragma once

namespace {

using alhazen::RasterBatch;
using alhazen::RasterTarget;
using alhazen::RasterTriangle;

#define ALHAZEN_INLINE __attribute__((always_inline)) inline

using Floats = float __attribute__((vector_size(32)));
using Ints = std::int32_t __attribute__((vector_size(32)));

constexpr std::int32_t block = alhazen::raster_block, block_pixels = alhazen::raster_block_pixels;
constexpr std::int32_t subpixels = alhazen::raster_subpixels, subpixel_bits = alhazen::raster_subpixel_bits;
// Within a block an edge function changes by less than this, as triangles have sides below 2^14 pixels.
constexpr std::int64_t far_away = std::int64_t{1} << 30;
// Changes after which a block's far side is worth finding again.
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

/// The edge's whole part at the sample of the block's first pixel.
ALHAZEN_INLINE std::int32_t edge_at(const RasterTriangle& t, int e, std::int64_t x, std::int64_t y) {
    const std::int64_t value = (t.a[e] * x + t.b[e] * y + t.c[e]) >> subpixel_bits;
    return static_cast<std::int32_t>(value < -far_away ? -far_away : value > far_away ? far_away : value);
}

/// Whether all samples of the block's pixels are outside of one edge, by the corner farthest inside. The
/// corner is that of the pixels' area, in which all samples are.
ALHAZEN_INLINE bool misses(const RasterTriangle& t, std::int32_t bx, std::int32_t by) {
    bool miss = false;
    for (int e = 0; e < 3; ++e) {
        const std::int64_t x = std::int64_t{bx + (t.a[e] > 0 ? block : 0)} * subpixels;
        const std::int64_t y = std::int64_t{by + (t.b[e] > 0 ? block : 0)} * subpixels;
        miss |= t.a[e] * x + t.b[e] * y + t.c[e] < 0;
    }
    return miss;
}

/// Whether it is no larger than a block, so that asking which blocks it misses does not pay.
ALHAZEN_INLINE bool fits_block(const RasterTriangle& t) {
    return t.x1 - t.x0 <= block && t.y1 - t.y0 <= block;
}

ALHAZEN_INLINE void find_far_side(RasterTarget& target, std::int32_t number) {
    const float* nearness =
        target.nearness + static_cast<std::size_t>(number) * target.samples * block_pixels;
    Floats least = load<Floats>(nearness);
    for (std::uint32_t i = 8; i < target.samples * block_pixels; i += 8) {
        const Floats other = load<Floats>(nearness + i);
        least = other < least ? other : least;
    }
    float smallest = least[0];
    for (int i = 1; i < 8; ++i) smallest = least[i] < smallest ? least[i] : smallest;
    target.block_nearness[number] = smallest;
    target.block_changes[number] = 0;
}

/// The triangle's largest nearness over the block.
ALHAZEN_INLINE float nearest_in_block(const RasterTriangle& t, std::int32_t bx, std::int32_t by) {
    const double x = bx + (t.qx > 0 ? block : 0), y = by + (t.qy > 0 ? block : 0);
    const auto corner = static_cast<float>(t.q0 + t.qx * x + t.qy * y);
    // A little more, since this is rounded otherwise than the samples' nearness.
    const float most = corner + (corner < 0 ? -corner : corner) * 1e-6f;
    return most < t.q_max ? most : t.q_max;
}

/// Rows first ... end - 1 of one sample of the block; whether anything was drawn. filter: see RasterBatch.
template <class Filter>
ALHAZEN_INLINE bool draw_sample(const RasterTriangle& t, std::int32_t bx, std::int32_t by, std::int32_t first,
                                std::int32_t end, std::int32_t sample_x, std::int32_t sample_y,
                                float* nearness, std::uint32_t* fragment, std::uint32_t number,
                                const Filter& filter) {
    const Ints lane = {0, 1, 2, 3, 4, 5, 6, 7};
    const std::int64_t x = std::int64_t{bx} * subpixels + sample_x;
    const std::int64_t y = std::int64_t{by} * subpixels + sample_y;
    Ints e0 = lane * t.a[0] + edge_at(t, 0, x, y) + first * t.b[0];
    Ints e1 = lane * t.a[1] + edge_at(t, 1, x, y) + first * t.b[1];
    Ints e2 = lane * t.a[2] + edge_at(t, 2, x, y) + first * t.b[2];
    constexpr double pixel = 1.0 / subpixels;
    const Floats along = {0, 1, 2, 3, 4, 5, 6, 7};
    const Floats start =
        along * static_cast<float>(t.qx) +
        static_cast<float>(t.q0 + t.qx * (bx + sample_x * pixel) + t.qy * (by + sample_y * pixel));
    const auto down = static_cast<float>(t.qy);
    Ints drawn{};
    for (std::int32_t row = first; row < end; ++row) {
        float* place = nearness + row * block;
        const Floats old = load<Floats>(place);
        Floats q = start + static_cast<float>(row) * down;
        q = q < t.q_min ? Floats{} + t.q_min : q;
        q = q > t.q_max ? Floats{} + t.q_max : q;
        Ints wins = ((e0 | e1 | e2) >= 0) & (q > old);
        filter(wins, row);
        store(place, wins ? q : old);
        const Ints before = load<Ints>(fragment + row * block);
        store(fragment + row * block, wins ? Ints{} + static_cast<std::int32_t>(number) : before);
        drawn |= wins;
        e0 += t.b[0];
        e1 += t.b[1];
        e2 += t.b[2];
    }
    using Halves = std::int64_t __attribute__((vector_size(32)));
    const Halves halves = load<Halves>(&drawn);
    return ((halves[0] | halves[1]) | (halves[2] | halves[3])) != 0;
}

ALHAZEN_INLINE void draw_in_block(RasterTarget& target, const RasterBatch& batch, const RasterTriangle& t,
                                  std::uint32_t number, std::int32_t bx, std::int32_t by) {
    const std::int32_t at = ((by - target.y) / block) * alhazen::raster_blocks + (bx - target.x) / block;
    if (target.block_changes[at] >= many_changes) find_far_side(target, at);
    if (!(nearest_in_block(t, bx, by) > target.block_nearness[at]) || (!fits_block(t) && misses(t, bx, by)))
        return;
    const std::int32_t first = t.y0 > by ? t.y0 - by : 0;
    const std::int32_t end = t.y1 < by + block ? t.y1 - by : block;
    bool drawn = false;
    for (std::uint32_t s = 0; s < target.samples; ++s) {
        const std::size_t place = (static_cast<std::size_t>(at) * target.samples + s) * block_pixels;
        const auto everywhere = [](Ints&, std::int32_t) {};
        const auto tested = [&](Ints& wins, std::int32_t row) {
            for (int i = 0; i < 8; ++i)
                if (wins[i] && !batch.accept(batch.owner, number, bx + i, by + row, s)) wins[i] = 0;
        };
        if (batch.accept)
            drawn |= draw_sample(t, bx, by, first, end, target.sample_x[s], target.sample_y[s],
                                 target.nearness + place, target.fragment + place, number, tested);
        else
            drawn |= draw_sample(t, bx, by, first, end, target.sample_x[s], target.sample_y[s],
                                 target.nearness + place, target.fragment + place, number, everywhere);
    }
    target.block_changes[at] += drawn;
}

void draw_batch(RasterTarget& target, const RasterBatch& batch) {
    for (std::uint32_t i = 0; i < batch.count; ++i) {
        const RasterTriangle& t = batch.triangles[batch.list[i]];
        const std::int32_t x0 = t.x0 > target.x ? (t.x0 - target.x) / block * block + target.x : target.x;
        const std::int32_t y0 = t.y0 > target.y ? (t.y0 - target.y) / block * block + target.y : target.y;
        const std::int32_t x1 =
            t.x1 < target.x + alhazen::raster_tile ? t.x1 : target.x + alhazen::raster_tile;
        const std::int32_t y1 =
            t.y1 < target.y + alhazen::raster_tile ? t.y1 : target.y + alhazen::raster_tile;
        for (std::int32_t by = y0; by < y1; by += block)
            for (std::int32_t bx = x0; bx < x1; bx += block)
                draw_in_block(target, batch, t, batch.first_fragment + batch.list[i], bx, by);
    }
}

#undef ALHAZEN_INLINE

} // namespace
