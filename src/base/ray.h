/// Rays, and origins that do not hit the surface they leave.
#pragma once

#include <bit>

#include "base/vec.h"

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
    float distance = dot(abs(ng), p_error);
    Vec3 offset = ng * distance;
    if (dot(w, ng) < 0) offset = -offset;
    Vec3 moved = p + offset;
    for (int i = 0; i < 3; ++i) {
        if (offset[i] > 0) moved[i] = next_up(moved[i]);
        if (offset[i] < 0) moved[i] = next_down(moved[i]);
    }
    return moved;
}

} // namespace alhazen
