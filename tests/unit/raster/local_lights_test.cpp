/// Light from around and from middles, against closed forms.
#include <gtest/gtest.h>

#include "base/hash.h"
#include "math/warp.h"
#include "raster/local_lights.h"

namespace alhazen::testing {
namespace {

TEST(SphericalHarmonics, AreOrthonormal) {
    // Midpoints over the square that maps onto the sphere with equal areas.
    constexpr int side = 400;
    std::array<std::array<double, 9>, 9> sum{};
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
            const Vec3 w =
                sample_sphere({(static_cast<float>(i) + 0.5f) / side, (static_cast<float>(j) + 0.5f) / side});
            const auto y = spherical_harmonics(w);
            for (std::size_t a = 0; a < 9; ++a)
                for (std::size_t b = 0; b < 9; ++b) sum[a][b] += static_cast<double>(y[a] * y[b]);
        }
    for (std::size_t a = 0; a < 9; ++a)
        for (std::size_t b = 0; b < 9; ++b)
            EXPECT_NEAR(sum[a][b] * 4 * static_cast<double>(pi) / (side * side), a == b ? 1 : 0, 1e-3)
                << a << b;
}

TEST(SphericalHarmonics, UniformLightGivesPiTimesItsRadiance) {
    RadianceHarmonics harmonics;
    constexpr int side = 64;
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i)
            harmonics.add(
                sample_sphere({(static_cast<float>(i) + 0.5f) / side, (static_cast<float>(j) + 0.5f) / side}),
                Spectrum(2.0f), 4 * pi / (side * side));
    for (Vec3 n : {Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{0.6f, 0, 0.8f}})
        EXPECT_NEAR(harmonics.irradiance(n)[0], 2 * pi, 2e-3);
}

// Irradiance under a sky L = 1 + cos(theta): pi + (2 pi / 3) cos(angle to the zenith), which degree 1 holds
// exactly.
TEST(SphericalHarmonics, ALinearSkyIsExact) {
    RadianceHarmonics harmonics;
    constexpr int side = 128;
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
            const Vec3 w =
                sample_sphere({(static_cast<float>(i) + 0.5f) / side, (static_cast<float>(j) + 0.5f) / side});
            harmonics.add(w, Spectrum(1 + w.z), 4 * pi / (side * side));
        }
    for (Vec3 n : {Vec3{0, 0, 1}, Vec3{0, 0, -1}, Vec3{0.6f, 0, 0.8f}, Vec3{0, 1, 0}})
        EXPECT_NEAR(harmonics.irradiance(n)[2], pi + 2 * pi / 3 * n.z, 3e-3);
}

// A light in one direction only: the series of the clamped cosine up to degree 2, 1/4 + c/2 + 5/32 (3 c^2 -
// 1), misses it by at most 3/32, at a right angle.
TEST(SphericalHarmonics, OneDirectionIsACosineToATenth) {
    RadianceHarmonics harmonics;
    harmonics.add({0, 0, 1}, 1, 1);
    for (int i = 0; i <= 180; ++i) {
        const float angle = radians(static_cast<float>(i));
        const Vec3 n{std::sin(angle), 0, std::cos(angle)};
        EXPECT_NEAR(harmonics.irradiance(n)[0], std::max(0.0f, n.z), 0.0945);
    }
}

} // namespace
} // namespace alhazen::testing
