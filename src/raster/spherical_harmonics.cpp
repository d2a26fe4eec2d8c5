#include "raster/spherical_harmonics.h"

namespace alhazen {

// Sloan 2008, "Stupid Spherical Harmonics Tricks", appendix A2.
std::array<float, 9> spherical_harmonics(Vec3 w) {
    constexpr float c0 = 0.28209479177387814f;  // sqrt(1 / (4 pi))
    constexpr float c1 = 0.48860251190291992f;  // sqrt(3 / (4 pi))
    constexpr float c2 = 1.0925484305920792f;   // sqrt(15 / (4 pi))
    constexpr float c20 = 0.31539156525252005f; // sqrt(5 / (16 pi))
    return {c0,
            c1 * w.y,
            c1 * w.z,
            c1 * w.x,
            c2 * w.x * w.y,
            c2 * w.y * w.z,
            c20 * (3 * w.z * w.z - 1),
            c2 * w.x * w.z,
            c2 / 2 * (w.x * w.x - w.y * w.y)};
}

void RadianceHarmonics::add(Vec3 w, Spectrum L, float solid_angle) {
    if (L.is_black()) return;
    is_black_ = false;
    const auto y = spherical_harmonics(w);
    for (std::size_t i = 0; i < 9; ++i) coefficients_[i] += L * (y[i] * solid_angle);
}

Spectrum RadianceHarmonics::irradiance(Vec3 n) const {
    // The cosine's own coefficients: pi, 2 pi / 3, pi / 4 for degrees 0, 1, 2.
    static constexpr std::array<float, 9> cosine{pi,     2 * pi / 3, 2 * pi / 3, 2 * pi / 3, pi / 4,
                                                 pi / 4, pi / 4,     pi / 4,     pi / 4};
    const auto y = spherical_harmonics(n);
    Spectrum sum = 0;
    for (std::size_t i = 0; i < 9; ++i) sum += coefficients_[i] * (cosine[i] * y[i]);
    return map(sum, [](float v) { return std::max(0.0f, v); });
}

} // namespace alhazen
