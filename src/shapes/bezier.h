/// Cubic Bezier curves: points, derivatives, pieces, bounds, and the ways from other bases (Farin 2002,
/// "Curves and Surfaces for CAGD").
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "base/vec.h"

namespace alhazen {

/// Control points.
using CubicBezier = std::array<Vec3, 4>;

inline Vec3 bezier_point(const CubicBezier& c, float u) {
    const float v = 1 - u;
    return c[0] * (v * v * v) + c[1] * (3 * v * v * u) + c[2] * (3 * v * u * u) + c[3] * (u * u * u);
}
inline Vec3 bezier_derivative(const CubicBezier& c, float u) {
    const float v = 1 - u;
    return ((c[1] - c[0]) * (v * v) + (c[2] - c[1]) * (2 * v * u) + (c[3] - c[2]) * (u * u)) * 3.0f;
}
inline Vec3 bezier_second_derivative(const CubicBezier& c, float u) {
    return ((c[2] - c[1] * 2.0f + c[0]) * (1 - u) + (c[3] - c[2] * 2.0f + c[1]) * u) * 6.0f;
}

/// The two halves, by de Casteljau.
struct BezierHalves {
    CubicBezier first, second;
};
inline BezierHalves halve(const CubicBezier& c) {
    auto middle = [](Vec3 a, Vec3 b) { return (a + b) * 0.5f; };
    const Vec3 a = middle(c[0], c[1]), b = middle(c[1], c[2]), d = middle(c[2], c[3]);
    const Vec3 ab = middle(a, b), bd = middle(b, d), m = middle(ab, bd);
    return {{c[0], a, ab, m}, {m, bd, d, c[3]}};
}
/// The part from u0 to u1. Where two parts meet their ends are the same to the last bit.
inline CubicBezier bezier_part(const CubicBezier& c, float u0, float u1) {
    const float third = (u1 - u0) / 3;
    const Vec3 from = bezier_point(c, u0), to = bezier_point(c, u1);
    return {from, from + bezier_derivative(c, u0) * third, to - bezier_derivative(c, u1) * third, to};
}

/// Smallest and largest coordinate on the axis.
inline std::array<float, 2> bezier_range(const CubicBezier& c, int axis) {
    float lo = std::min(c[0][axis], c[3][axis]), hi = std::max(c[0][axis], c[3][axis]);
    auto add = [&](float u) {
        if (!(u > 0 && u < 1)) return;
        const float x = bezier_point(c, u)[axis];
        lo = std::min(lo, x);
        hi = std::max(hi, x);
    };
    // Where the derivative a u^2 + 2 h u + k is zero.
    const float k = c[1][axis] - c[0][axis], h = c[2][axis] - c[1][axis] - k,
                a = (c[3][axis] - c[2][axis]) - (c[2][axis] - c[1][axis]) - h;
    const float discriminant = h * h - a * k;
    if (discriminant >= 0) {
        const float q = -h - std::copysign(std::sqrt(discriminant), h);
        add(q / a);
        add(k / q);
    }
    return {lo, hi};
}

inline CubicBezier cubic_of_quadratic_bezier(Vec3 a, Vec3 b, Vec3 c) {
    return {a, lerp(2.0f / 3, a, b), lerp(1.0f / 3, b, c), c};
}
/// The part of a uniform B-spline that three successive control points shape.
inline CubicBezier cubic_of_quadratic_spline(Vec3 a, Vec3 b, Vec3 c) {
    return cubic_of_quadratic_bezier(lerp(0.5f, a, b), b, lerp(0.5f, b, c));
}
/// The same of a cubic one, by four.
inline CubicBezier cubic_of_cubic_spline(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
    return {(a + b * 4.0f + c) / 6.0f, lerp(1.0f / 3, b, c), lerp(2.0f / 3, b, c), (b + c * 4.0f + d) / 6.0f};
}

} // namespace alhazen
