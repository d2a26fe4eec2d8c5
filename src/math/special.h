/// Special functions: small formulas that several rooms use.
#pragma once

#include "base/vec.h"

namespace alhazen {

/// The x with erf(x) = y, -1 <= y <= 1, within a few float roundings (Giles 2010, "Approximating the erfinv
/// function"). The ends give the finite value of the float next to them.
inline float erf_inv(float y) {
    y = std::clamp(y, -one_minus_epsilon, one_minus_epsilon);
    float w = -std::log((1 - y) * (1 + y));
    float p = 0;
    auto step = [&](float c) { p = p * w + c; };
    if (w < 5) {
        w -= 2.5f;
        for (float c : {2.81022636e-08f, 3.43273939e-07f, -3.5233877e-06f, -4.39150654e-06f, 0.00021858087f,
                        -0.00125372503f, -0.00417768164f, 0.246640727f, 1.50140941f})
            step(c);
    } else {
        w = std::sqrt(w) - 3;
        for (float c : {-0.000200214257f, 0.000100950558f, 0.00134934322f, -0.00367342844f, 0.00573950773f,
                        -0.0076224613f, 0.00943887047f, 1.00167406f, 2.83297682f})
            step(c);
    }
    return p * y;
}

/// Density of the normal distribution; sigma > 0.
inline float gaussian(float x, float mean = 0, float sigma = 1) {
    float t = (x - mean) / sigma;
    return std::exp(-0.5f * t * t) / (sigma * 2.50662827463f);
}
/// Its integral from a to b.
inline float gaussian_integral(float a, float b, float mean = 0, float sigma = 1) {
    float s = 1 / (sigma * 1.41421356237f);
    return 0.5f * (std::erf((b - mean) * s) - std::erf((a - mean) * s));
}

/// sin(pi x) / (pi x).
inline float sinc(float x) {
    float t = pi * x;
    // Below this, the first term that is left out is under a rounding.
    if (1 - t * t == 1) return 1;
    return std::sin(t) / t;
}
/// sinc in a Lanczos window, itself a sinc whose first zero is at radius; tau is the number of sinc lobes per
/// radius' unit (Duchon 1979). 0 from radius on.
inline float windowed_sinc(float x, float radius, float tau) {
    if (std::abs(x) > radius) return 0;
    return sinc(x) * sinc(x / tau);
}

/// Mitchell and Netravali's cubic (1988, "Reconstruction filters in computer graphics", equation 8) over
/// [-2, 2].
inline float mitchell(float x, float b, float c) {
    x = std::abs(x);
    if (x >= 2) return 0;
    if (x > 1)
        return ((-b - 6 * c) * x * x * x + (6 * b + 30 * c) * x * x + (-12 * b - 48 * c) * x +
                (8 * b + 24 * c)) /
               6;
    return ((12 - 9 * b - 6 * c) * x * x * x + (-18 + 12 * b + 6 * c) * x * x + (6 - 2 * b)) / 6;
}

/// The modified Bessel function I0 of x >= 0, times exp(-x), within a few float roundings: by its series, and
/// far out by its asymptotic one (Abramowitz and Stegun 1964, 9.6.12 and 9.7.1).
inline float bessel_i0_scaled(float x) {
    if (x > 12) {
        const float y = 1 / (8 * x);
        return (1 + y * (1 + y * (4.5f + y * (37.5f + y * 459.375f)))) / std::sqrt(2 * pi * x);
    }
    double sum = 1, term = 1;
    const double quarter = static_cast<double>(x) * static_cast<double>(x) / 4;
    for (int i = 1; term > sum * 1e-8; ++i) sum += term *= quarter / (i * i);
    return static_cast<float>(sum * std::exp(-static_cast<double>(x)));
}

} // namespace alhazen
