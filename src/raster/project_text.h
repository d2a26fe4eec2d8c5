/// Points taken onto the film, four at a time, once for every instruction set.
#pragma once

#include "raster/setup_text.h"

namespace {

using alhazen::RasterCorner;
using alhazen::RasterProjection;

using Doubles = double __attribute__((vector_size(32)));
using Longs = std::int64_t __attribute__((vector_size(32)));

struct FourPoints {
    Doubles x, y, z;
};

/// v rounded to subpixels; |v| is below 2^14.
ALHAZEN_INLINE void round_to_subpixels(const Doubles& v, std::int32_t (&fixed)[4]) {
    // Made positive, so that cutting the fraction off rounds down.
    constexpr std::int32_t shift = 1 << 27;
    const Doubles shifted = v * alhazen::raster_subpixels + (shift + 0.5);
    for (int i = 0; i < 4; ++i) fixed[i] = static_cast<std::int32_t>(shifted[i]) - shift;
}

ALHAZEN_INLINE void project_four(const RasterProjection& to, const FourPoints& p, RasterCorner (&corners)[4],
                                 std::uint8_t (&sides)[4]) {
    auto row = [&](int r) {
        const double(&m)[4] = to.rows[r];
        return m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3];
    };
    const Doubles xw = row(0), yw = row(1), depth = row(2), w = row(3);
    constexpr double low = alhazen::raster_guard_low, high = alhazen::raster_guard_high;
    const Doubles inverse = to.is_perspective ? 1 / w : Doubles{1, 1, 1, 1};
    Doubles x = xw * inverse, y = yw * inverse;
    const Doubles q = to.is_perspective ? inverse : -depth;
    const Longs within = (x >= low) & (x <= high) & (y >= low) & (y <= high);
    auto bit = [](const Longs& is_set, alhazen::RasterSide side) {
        return is_set & static_cast<std::int64_t>(side);
    };
    const Longs beyond =
        bit(xw < to.left * w, alhazen::raster_left) | bit(xw > to.right * w, alhazen::raster_right) |
        bit(yw < to.above * w, alhazen::raster_above) | bit(yw > to.below * w, alhazen::raster_below) |
        bit(~(depth >= to.near_depth), alhazen::raster_behind) | bit(~within, alhazen::raster_beyond_guard);
    x = x >= low ? x : low + Doubles{};
    x = x <= high ? x : high + Doubles{};
    y = y >= low ? y : low + Doubles{};
    y = y <= high ? y : high + Doubles{};
    std::int32_t fixed_x[4], fixed_y[4];
    round_to_subpixels(x, fixed_x);
    round_to_subpixels(y, fixed_y);
    for (int i = 0; i < 4; ++i) {
        corners[i] = {x[i], y[i], q[i], fixed_x[i], fixed_y[i]};
        sides[i] = static_cast<std::uint8_t>(beyond[i]);
    }
}

void project_points(const RasterProjection& to, const float* points, std::size_t count, RasterCorner* corners,
                    std::uint8_t* sides) {
    for (std::size_t first = 0; first < count; first += 4) {
        const std::size_t left = count - first < 4 ? count - first : 4;
        FourPoints four{};
        for (std::size_t i = 0; i < 4; ++i) {
            const float* p = points + 3 * (first + (i < left ? i : 0));
            four.x[i] = static_cast<double>(p[0]);
            four.y[i] = static_cast<double>(p[1]);
            four.z[i] = static_cast<double>(p[2]);
        }
        RasterCorner made[4];
        std::uint8_t beyond[4];
        project_four(to, four, made, beyond);
        for (std::size_t i = 0; i < left; ++i) {
            corners[first + i] = made[i];
            sides[first + i] = beyond[i];
        }
    }
}

} // namespace
