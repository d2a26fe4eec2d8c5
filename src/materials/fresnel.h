/// Mirrors, Snell and Fresnel: which way light goes on at a smooth border, and how much of it. eta is always
/// the index below the surface (z < 0) over the index above.
#pragma once

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

/// The same for a conductor with index eta - i k; 0 <= cos_i <= 1, eta and k not negative. The cosine beyond
/// the border is complex; written out by real and imaginary part (Born and Wolf 1999, section 14.2), it
/// needs real numbers only.
inline Spectrum fresnel_conductor(float cos_i, Spectrum eta, Spectrum k) {
    using Lanes = Spectrum::Lanes;
    cos_i = std::clamp(cos_i, 0.0f, 1.0f);
    const float cos2 = sqr(cos_i), sin2 = 1 - cos2;
    // Anything above reflects all to the last bit, and its fourth power overflows.
    constexpr float largest_index = 1e9f;
    const Lanes n = clamp(eta, 0, largest_index).lanes, m = clamp(k, 0, largest_index).lanes;
    // index^2 - sin^2 = (a + i b)^2: of a^2 and b^2 the larger is a sum, the smaller follows from a b = n k.
    const Lanes real = n * n - m * m - sin2, n2k2 = (n * n) * (m * m);
    const Lanes a2_plus_b2 = sqrt(Spectrum(real * real + 4 * n2k2)).lanes;
    const Lanes larger = 0.5f * (a2_plus_b2 + (real < 0 ? -real : real));
    const Lanes smaller = larger > 0 ? n2k2 / larger : larger;
    const Lanes two_a_cos = 2 * cos_i * sqrt(Spectrum(real < 0 ? smaller : larger)).lanes;
    // Where a denominator vanishes, light runs along the border.
    auto ratio = [](Lanes sum, Lanes term) {
        const Lanes below = sum + term;
        return below > 0 ? (sum - term) / below : Lanes{1, 1, 1, 1};
    };
    const Lanes perpendicular = ratio(a2_plus_b2 + cos2, two_a_cos);
    const Lanes parallel = perpendicular * ratio(cos2 * a2_plus_b2 + sin2 * sin2, two_a_cos * sin2);
    return Spectrum(0.5f * (perpendicular + parallel));
}
inline float fresnel_conductor(float cos_i, float eta, float k) {
    return fresnel_conductor(cos_i, Spectrum(eta), Spectrum(k))[0];
}

} // namespace alhazen
