/// Densities over a line or the unit square with a closed form: drawing from them, their value, and the
/// inverse. Picture each as the height of a small landscape; the sample functions drop points where it is
/// high.
#pragma once

#include <array>

#include "base/vec.h"
#include "math/special.h"

namespace alhazen {

/// exp(-rate x) over x >= 0; rate > 0, u in [0, 1).
inline float sample_exponential(float u, float rate) {
    return -std::log1p(-u) / rate;
}
inline float exponential_pdf(float x, float rate) {
    return x < 0 ? 0 : rate * std::exp(-rate * x);
}
inline float invert_exponential(float x, float rate) {
    return -std::expm1(-rate * x);
}

/// 1 - |x| / radius over [-radius, radius]; radius > 0.
inline float sample_tent(float u, float radius) {
    return u < 0.5f ? radius * (std::sqrt(2 * u) - 1) : radius * (1 - safe_sqrt(2 * (1 - u)));
}
inline float tent_pdf(float x, float radius) {
    return std::abs(x) >= radius ? 0 : (1 - std::abs(x) / radius) / radius;
}
inline float invert_tent(float x, float radius) {
    float side = 0.5f * sqr(1 - std::min(1.0f, std::abs(x) / radius));
    return x < 0 ? side : 1 - side;
}

/// The normal distribution; sigma > 0. u = 0 gives the far but finite end.
inline float sample_normal(float u, float mean = 0, float sigma = 1) {
    constexpr float sqrt2 = 1.41421356237f;
    return mean + sqrt2 * sigma * erf_inv(2 * u - 1);
}
inline float normal_pdf(float x, float mean = 0, float sigma = 1) {
    return gaussian(x, mean, sigma);
}
inline float invert_normal(float x, float mean = 0, float sigma = 1) {
    constexpr float sqrt2 = 1.41421356237f;
    return 0.5f * (1 + std::erf((x - mean) / (sigma * sqrt2)));
}
/// Two independent standard normal numbers (Box and Muller 1958); u.x in [0, 1).
inline Vec2 sample_two_normals(Vec2 u) {
    float r = std::sqrt(-2 * std::log1p(-u.x));
    float phi = 2 * pi * u.y;
    return {r * std::cos(phi), r * std::sin(phi)};
}

/// A straight line from a at x = 0 to b at x = 1; a, b >= 0. Both 0 counts as uniform.
inline float sample_linear(float u, float a, float b) {
    if (a + b <= 0) return u;
    // This form of the quadratic's root is stable for a near b and for either 0.
    if (u == 0) return 0;
    float x = u * (a + b) / (a + std::sqrt(lerp(u, a * a, b * b)));
    return std::min(x, one_minus_epsilon);
}
inline float linear_pdf(float x, float a, float b) {
    if (x < 0 || x > 1) return 0;
    return a + b <= 0 ? 1 : 2 * lerp(x, a, b) / (a + b);
}
inline float invert_linear(float x, float a, float b) {
    return a + b <= 0 ? x : x * (a * (2 - x) + b * x) / (a + b);
}

/// The smooth step x^2 (3 - 2 x) from 0 at x = 0 to 1 at x = 1, doubled to integrate to 1.
inline float smooth_step_pdf(float x) {
    return x < 0 || x > 1 ? 0 : 2 * x * x * (3 - 2 * x);
}
inline float invert_smooth_step(float x) {
    return x * x * x * (2 - x);
}
inline float sample_smooth_step(float u) {
    // Newton's method on a convex function from the right of its root, and near it: no step goes too far.
    float x = std::cbrt(u);
    for (int i = 0; i < 5 && x > 0; ++i) x -= (invert_smooth_step(x) - u) / smooth_step_pdf(x);
    return std::clamp(x, 0.0f, 1.0f);
}

/// Bilinear over the unit square from the heights at (0,0), (1,0), (0,1), (1,1), all >= 0. All 0 counts as
/// uniform.
using BilinearHeights = std::array<float, 4>;
inline Vec2 sample_bilinear(Vec2 u, const BilinearHeights& w) {
    float y = sample_linear(u.y, w[0] + w[1], w[2] + w[3]);
    return {sample_linear(u.x, lerp(y, w[0], w[2]), lerp(y, w[1], w[3])), y};
}
inline float bilinear_pdf(Vec2 p, const BilinearHeights& w) {
    if (p.x < 0 || p.x > 1 || p.y < 0 || p.y > 1) return 0;
    float sum = (w[0] + w[1]) + (w[2] + w[3]);
    if (sum <= 0) return 1;
    return 4 * lerp(p.y, lerp(p.x, w[0], w[1]), lerp(p.x, w[2], w[3])) / sum;
}
inline Vec2 invert_bilinear(Vec2 p, const BilinearHeights& w) {
    return {invert_linear(p.x, lerp(p.y, w[0], w[2]), lerp(p.y, w[1], w[3])),
            invert_linear(p.y, w[0] + w[1], w[2] + w[3])};
}

} // namespace alhazen
