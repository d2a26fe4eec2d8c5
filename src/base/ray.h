/// Rays, and origins that do not hit the surface they leave.
#pragma once

#include <bit>

#include "base/lanes.h"

namespace alhazen {

/// The half-line o + t d, 0 < t < tmax. d need not have unit length.
struct Ray {
    Vec3 o;
    Vec3 d;
    float tmax = infinity;
    float time = 0;

    Vec3 at(float t) const { return o + d * t; }
};

/// Bound of the relative rounding error of n floating-point operations in sequence (Higham 2002,
/// section 3.1).
inline constexpr float gamma_bound(int n) {
    constexpr float half_epsilon = 0x1p-24f;
    return static_cast<float>(n) * half_epsilon / (1 - static_cast<float>(n) * half_epsilon);
}

/// The next float above v.
inline float next_up(float v) {
    if (std::isinf(v) && v > 0) return v;
    if (v == 0) return std::bit_cast<float>(std::uint32_t{1});
    auto bits = std::bit_cast<std::uint32_t>(v);
    return std::bit_cast<float>(v > 0 ? bits + 1 : bits - 1);
}
inline float next_down(float v) {
    return -next_up(-v);
}

/// Moves p, known to within +-p_error, off the surface with normal ng to the side of w, by just enough that a
/// ray starting there cannot meet the surface again (Waechter and Binder 2019; Pharr et al. 2023,
/// section 6.8.6).
inline Vec3 offset_origin(Vec3 p, Vec3 p_error, Vec3 ng, Vec3 w) {
    const float distance = std::copysign(dot(abs(ng), p_error), dot(w, ng));
    const Lanes4 offset = to_lanes(ng) * distance, moved = to_lanes(p) + offset;
    // To the next float along the offset; without branches, since signs cannot be foreseen.
    const IntLanes4 up = offset > 0, down = offset < 0, bits = std::bit_cast<IntLanes4>(moved);
    const IntLanes4 is_negative = bits >> 31, step = ((down - up) ^ is_negative) - is_negative;
    const IntLanes4 beside_zero = (up & 1) | (down & static_cast<int>(0x80000001u));
    const IntLanes4 next = moved == 0 ? beside_zero : bits + step;
    return to_vec3(std::bit_cast<Lanes4>(next));
}

} // namespace alhazen
