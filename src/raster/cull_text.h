/// Which triangles may be seen at all, eight at a time, once for every instruction set: most of a finely
/// divided surface's are beside the picture, or between samples.
#pragma once

#include "raster/setup_text.h"

namespace {

using alhazen::RasterCorner;
using alhazen::RasterPart;
using alhazen::RasterTriangle;

using EightInts = std::int32_t __attribute__((vector_size(32)));

/// Of eight triangles.
struct EightTriangles {
    EightInts x[3], y[3];       ///< corners, subpixels
    EightInts beyond, anywhere; ///< sides that all corners are beyond, and those that any is
};

ALHAZEN_INLINE EightInts least(const EightInts& a, const EightInts& b) {
    return a < b ? a : b;
}
ALHAZEN_INLINE EightInts most(const EightInts& a, const EightInts& b) {
    return a > b ? a : b;
}
ALHAZEN_INLINE EightInts clamped(const EightInts& v, std::int32_t low, std::int32_t high) {
    return least(most(v, EightInts{} + low), EightInts{} + high);
}

/// From the least and largest coordinate to the pixels first ... end - 1 that hold samples.
ALHAZEN_INLINE void pixel_range(EightInts& low, EightInts& high, bool single_sample) {
    constexpr std::int32_t half = alhazen::raster_subpixels / 2;
    if (single_sample) {
        low += half - 1; // the first middle at or after
        high -= half;    // the last at or before
    }
    // Shifts round down.
    low = low >> alhazen::raster_subpixel_bits;
    high = (high >> alhazen::raster_subpixel_bits) + 1;
}

/// Of triangles within two pixels across and down, the first of which is at x, y: whether one of the pixels'
/// middles is inside. Of others it says nothing.
ALHAZEN_INLINE EightInts covers_middles(const EightTriangles& t, const EightInts& is_small,
                                        const EightInts& x, const EightInts& y) {
    constexpr std::int32_t pixel = alhazen::raster_subpixels;
    // From the first middle; 32 bits are enough for small triangles.
    EightInts px[3], py[3];
    for (int i = 0; i < 3; ++i) {
        px[i] = (t.x[i] - (x * pixel + pixel / 2)) & is_small;
        py[i] = (t.y[i] - (y * pixel + pixel / 2)) & is_small;
    }
    const EightInts area = (px[1] - px[0]) * (py[2] - py[0]) - (px[2] - px[0]) * (py[1] - py[0]);
    const EightInts is_turned = area < 0;
    // Signs of the edge functions at the four middles: negative where it is outside of one.
    EightInts outside[4] = {};
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        EightInts a = py[i] - py[j], b = px[j] - px[i];
        a = is_turned ? -a : a;
        b = is_turned ? -b : b;
        const EightInts is_top_left = (a > 0) | ((a == 0) & (b > 0));
        // One less where it is not.
        const EightInts c = -(a * px[i] + b * py[i]) - 1 - is_top_left;
        outside[0] |= c;
        outside[1] |= c + a * pixel;
        outside[2] |= c + b * pixel;
        outside[3] |= c + (a + b) * pixel;
    }
    const EightInts covered = (outside[0] >= 0) | (outside[1] >= 0) | (outside[2] >= 0) | (outside[3] >= 0);
    return covered & (area != 0);
}

ALHAZEN_INLINE EightTriangles gather_eight(const RasterCorner* corners, const std::uint8_t* sides,
                                           const std::uint16_t* numbers, std::size_t count) {
    EightTriangles t;
    for (int c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < 8; ++i) {
            const std::uint16_t n = numbers[3 * (i < count ? i : 0) + static_cast<std::size_t>(c)];
            t.x[c][i] = corners[n].fixed_x;
            t.y[c][i] = corners[n].fixed_y;
            t.beyond[i] = c == 0 ? sides[n] : t.beyond[i] & sides[n];
            t.anywhere[i] = c == 0 ? sides[n] : t.anywhere[i] | sides[n];
        }
    return t;
}

std::size_t cull_triangles(const RasterPart& part, const RasterCorner* corners, const std::uint8_t* sides,
                           const std::uint16_t* numbers, std::size_t count, RasterTriangle* kept) {
    constexpr std::int32_t must_cut = alhazen::raster_behind | alhazen::raster_beyond_guard;
    std::size_t kept_count = 0;
    for (std::size_t first = 0; first < count; first += 8) {
        const std::uint16_t* number = numbers + 3 * first;
        const EightTriangles t = gather_eight(corners, sides, number, count - first);
        const EightInts is_cut = (t.anywhere & must_cut) != 0;
        const EightInts is_beside = (t.beyond & ~std::int32_t{alhazen::raster_beyond_guard}) != 0;
        EightInts x0 = least(least(t.x[0], t.x[1]), t.x[2]), x1 = most(most(t.x[0], t.x[1]), t.x[2]);
        EightInts y0 = least(least(t.y[0], t.y[1]), t.y[2]), y1 = most(most(t.y[0], t.y[1]), t.y[2]);
        const EightInts extent = most(x1 - x0, y1 - y0);
        pixel_range(x0, x1, part.single_sample);
        pixel_range(y0, y1, part.single_sample);
        EightInts seen = ~EightInts{};
        if (part.single_sample) {
            const EightInts is_small =
                (extent < 3 * alhazen::raster_subpixels) & (x1 - x0 <= 2) & (y1 - y0 <= 2);
            seen = ~is_small | covers_middles(t, is_small, x0, y0);
        }
        x0 = clamped(x0, part.x0, part.x1);
        x1 = clamped(x1, part.x0, part.x1);
        y0 = clamped(y0, part.y0, part.y1);
        y1 = clamped(y1, part.y0, part.y1);
        seen = ~is_beside & (is_cut | (seen & (x0 < x1) & (y0 < y1)));
        for (std::size_t i = 0; i < 8 && first + i < count; ++i) {
            // Written either way: a branch would often be foretold wrongly.
            RasterTriangle& k = kept[kept_count];
            for (std::size_t c = 0; c < 3; ++c) k.corner[c] = number[3 * i + c];
            k.plane = is_cut[i] ? RasterTriangle::to_clip : RasterTriangle::no_plane;
            k.primitive = static_cast<std::uint32_t>(first + i);
            const double a = corners[k.corner[0]].q, b = corners[k.corner[1]].q, c = corners[k.corner[2]].q;
            const double q = a > b ? a : b;
            k.q_max = static_cast<float>(q > c ? q : c);
            k.x0 = static_cast<std::int16_t>(x0[i]);
            k.x1 = static_cast<std::int16_t>(x1[i]);
            k.y0 = static_cast<std::int16_t>(y0[i]);
            k.y1 = static_cast<std::int16_t>(y1[i]);
            kept_count += seen[i] != 0;
        }
    }
    return kept_count;
}

} // namespace
