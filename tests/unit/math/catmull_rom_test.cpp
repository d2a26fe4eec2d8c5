#include "math/catmull_rom.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace alhazen {
namespace {

const std::vector<float> nodes{0, 0.1f, 0.25f, 0.5f, 1, 1.75f, 3};

std::vector<float> values_of(float (*f)(float)) {
    std::vector<float> values;
    for (float x : nodes) values.push_back(f(x));
    return values;
}

TEST(CatmullRom, GoesThroughItsPointsAndIsExactForLines) {
    const auto wave = values_of([](float x) { return std::sin(2 * x) + 2; });
    for (std::size_t i = 0; i < nodes.size(); ++i)
        EXPECT_NEAR(spline_weights(nodes, nodes[i]).sum(wave.data()), wave[i], 1e-6f);
    const auto line = values_of([](float x) { return 3 * x - 1; });
    for (float x = 0; x <= 3; x += 0.01f)
        EXPECT_NEAR(spline_weights(nodes, x).sum(line.data()), 3 * x - 1, 2e-6f) << x;
    EXPECT_NEAR(spline_weights(nodes, 99).sum(line.data()), 8, 1e-6f);
    EXPECT_NEAR(spline_weights(nodes, -1).sum(line.data()), -1, 1e-6f);
}

TEST(CatmullRom, IsNearASmoothFunction) {
    std::vector<float> fine, sines;
    for (int i = 0; i <= 40; ++i) {
        fine.push_back(0.1f * static_cast<float>(i));
        sines.push_back(std::sin(fine.back()));
    }
    for (float x = 0.2f; x < 3.8f; x += 0.013f)
        EXPECT_NEAR(spline_weights(fine, x).sum(sines.data()), std::sin(x), 1e-4f);
}

// The two ways to evaluate it, and its integral by the midpoint rule.
TEST(CatmullRom, PiecesAreTheWholeCurve) {
    const auto values = values_of([](float x) { return std::exp(-x) + 0.2f * x; });
    std::vector<float> cdf(nodes.size());
    const float whole = integrate_spline(nodes, values, cdf);
    double sum = 0;
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
        EXPECT_NEAR(cdf[i], sum, 2e-6);
        const SplinePiece piece = spline_piece(
            nodes, [&](std::size_t j) { return values[j]; }, i);
        constexpr int n = 200;
        for (int k = 0; k < n; ++k) {
            const float t = (static_cast<float>(k) + 0.5f) / n, x = nodes[i] + t * piece.width;
            ASSERT_NEAR(piece.at(t), spline_weights(nodes, x).sum(values.data()), 2e-6f);
            sum += static_cast<double>(piece.at(t) * piece.width / n);
            ASSERT_NEAR(piece.invert_integral(piece.integral(t)), t, 2e-5f);
        }
    }
    EXPECT_NEAR(whole, sum, 1e-5);
}

TEST(CatmullRom, IncreasingCurvesAreInverted) {
    const auto values = values_of([](float x) { return x * x + x; });
    for (float x = 0; x <= 3; x += 0.03f) {
        const float y = spline_weights(nodes, x).sum(values.data());
        EXPECT_NEAR(invert_spline(nodes, values, y), x, 1e-5f);
    }
    EXPECT_EQ(invert_spline(nodes, values, -5), 0);
    EXPECT_EQ(invert_spline(nodes, values, 50), 3);
}

} // namespace
} // namespace alhazen
