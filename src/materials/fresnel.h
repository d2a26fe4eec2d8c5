/// Mirrors, Snell and Fresnel: which way light goes on at a smooth border, and how much of it. eta is always
/// the index below the surface (z < 0) over the index above.
#pragma once

#include <complex>
#include <optional>

#include "base/vec.h"
#include "color/spectrum.h"

namespace alhazen {

/// w mirrored about the unit vector n.
inline Vec3 reflect(Vec3 w, Vec3 n) {
    return n * (2 * dot(w, n)) - w;
}

struct Refraction {
    Vec3 wt;
    float eta = 1; ///< index on the side of wt over that on the side of w
};
/// Where w goes on through a border with normal n; nullopt on total internal reflection. The side of n that w
/// is on tells entering from leaving (Snell).
inline std::optional<Refraction> refract(Vec3 w, Vec3 n, float eta) {
    float cos_i = dot(w, n);
    if (cos_i < 0) {
        cos_i = -cos_i;
        n = -n;
        eta = 1 / eta;
    }
    float sin2_i = std::max(0.0f, 1 - sqr(cos_i));
    float sin2_t = sin2_i / sqr(eta);
    if (sin2_t >= 1) return std::nullopt;
    float cos_t = std::sqrt(1 - sin2_t);
    Vec3 wt = n * (cos_i / eta - cos_t) - w / eta;
    return Refraction{normalize(wt), eta};
}

/// Fraction of unpolarised light that a dielectric border reflects; cos_i < 0 comes from below. Exact (Born
/// and Wolf 1999, section 1.5.2).
inline float fresnel_dielectric(float cos_i, float eta) {
    cos_i = std::clamp(cos_i, -1.0f, 1.0f);
    if (cos_i < 0) {
        cos_i = -cos_i;
        eta = 1 / eta;
    }
    float sin2_t = (1 - sqr(cos_i)) / sqr(eta);
    if (sin2_t >= 1) return 1;
    float cos_t = safe_sqrt(1 - sin2_t);
    float parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    float perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    return (sqr(parallel) + sqr(perpendicular)) / 2;
}

/// The same for a conductor with index eta - i k; 0 <= cos_i <= 1.
inline float fresnel_conductor(float cos_i, float eta, float k) {
    using Complex = std::complex<float>;
    cos_i = std::clamp(cos_i, 0.0f, 1.0f);
    Complex index(eta, k);
    // An index of 0 bends light along the border and keeps none of it.
    if (index == Complex(0)) return 1;
    Complex sin_t2 = (1 - sqr(cos_i)) / (index * index);
    Complex cos_t = std::sqrt(1.0f - sin_t2);
    Complex parallel = (index * cos_i - cos_t) / (index * cos_i + cos_t);
    Complex perpendicular = (cos_i - index * cos_t) / (cos_i + index * cos_t);
    return (std::norm(parallel) + std::norm(perpendicular)) / 2;
}
inline Spectrum fresnel_conductor(float cos_i, Spectrum eta, Spectrum k) {
    auto lane = [&](int i) { return fresnel_conductor(cos_i, eta[i], k[i]); };
    return {lane(0), lane(1), lane(2), lane(3)};
}

} // namespace alhazen
