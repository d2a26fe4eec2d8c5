#include "math/distribution.h"

#include <array>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "base/ray.h"
#include "math/special.h"
#include "tests/support/density_test.h"

namespace alhazen {
namespace {

using testing_support::chi_square_1d;
using testing_support::chi_square_2d;
using testing_support::p_threshold;

TEST(PiecewiseConstant1D, SamplesItsDensity) {
    const std::array<float, 8> heights{0, 1, 4, -2, 0, 0, 1, 0};
    PiecewiseConstant1D d(heights, -1, 3);
    EXPECT_NEAR(d.integral(), 8 * 0.5f, 1e-6f);
    EXPECT_GT(chi_square_1d([&](float u) { return d.sample(u).x; }, [&](float x) { return d.pdf(x); }, -1, 3),
              p_threshold);
    for (float u : {0.0f, 0.1f, 0.3f, 0.77f, one_minus_epsilon}) {
        auto s = d.sample(u);
        EXPECT_GT(s.pdf, 0);
        EXPECT_NEAR(d.pdf(s.x), s.pdf, 1e-6f);
        EXPECT_NEAR(d.invert(s.x), u, 1e-6f);
    }
    EXPECT_EQ(d.pdf(-1.1f), 0);
    EXPECT_EQ(d.pdf(3.1f), 0);
}

TEST(PiecewiseConstant1D, NeverChoosesAnEmptyCell) {
    const std::array<float, 5> heights{0, 0, 1e-30f, 0, 0};
    PiecewiseConstant1D d(heights);
    for (float u : {0.0f, 0.5f, one_minus_epsilon, 1.0f}) EXPECT_EQ(d.sample(u).cell, 2);
}

// Where to look is known for parts of [0, 1): the cell is that of a search through all of them.
TEST(PiecewiseConstant1D, FindsTheCellThatNumbersFallInto) {
    Rng rng(5);
    for (const std::size_t n : {1u, 2u, 3u, 5u, 12u, 100u, 1000u}) {
        // Some without height, some a thousand times as tall as others.
        std::vector<float> heights(n);
        for (float& h : heights) h = rng.uniform() < 0.4f ? 0 : std::pow(1000.0f, rng.uniform());
        heights[n / 2] = 1;
        const PiecewiseConstant1D d(heights);
        double sum = 0, so_far = 0;
        for (const float h : heights) sum += static_cast<double>(h);
        std::vector<float> ends;
        for (const float h : heights)
            ends.push_back(static_cast<float>(so_far += static_cast<double>(h) / sum));
        std::vector<float> numbers{0, one_minus_epsilon};
        for (const float end : ends)
            for (const float u : {next_down(end), end, next_up(end)})
                if (u >= 0 && u < 1) numbers.push_back(u);
        for (std::size_t i = 0; i < 4 * n; ++i) {
            numbers.push_back(static_cast<float>(i) / static_cast<float>(4 * n));
            numbers.push_back(rng.uniform());
        }
        for (const float u : numbers) {
            // The last is the last that has height: rounding may have left a gap behind it.
            std::size_t wanted = 0, last = n - 1;
            while (heights[last] == 0) --last;
            while (wanted < last && ends[wanted] <= u) ++wanted;
            EXPECT_EQ(d.sample(u).cell, static_cast<int>(wanted)) << n << " cells, " << u;
        }
    }
}

TEST(PiecewiseConstant1D, AllZeroAndNotFiniteAreSafe) {
    const std::array<float, 4> zero{}, bad{std::nanf(""), infinity, -infinity, 1};
    PiecewiseConstant1D d(zero);
    EXPECT_EQ(d.integral(), 0);
    EXPECT_NEAR(d.pdf(0.3f), 1, 1e-6f);
    EXPECT_NEAR(d.sample(0.6f).x, 0.6f, 1e-6f);
    EXPECT_EQ(PiecewiseConstant1D(bad).sample(0.1f).cell, 3);
    EXPECT_EQ(PiecewiseConstant1D().sample(0.25f).x, 0.25f);
}

TEST(PiecewiseConstant2D, SamplesItsDensity) {
    const std::array<float, 12> heights{1, 2, 0, 4, 0, 0, 0, 0, 3, 0, 1, 0.5f};
    PiecewiseConstant2D d(heights, 4, 3);
    EXPECT_NEAR(d.integral(), 11.5f / 12, 1e-6f);
    EXPECT_GT(chi_square_2d([&](Vec2 u) { return d.sample(u).p; }, [&](Vec2 p) { return d.pdf(p); }, {},
                            200000, 12),
              p_threshold);
    Rng rng(2);
    for (int i = 0; i < 1000; ++i) {
        Vec2 u{rng.uniform(), rng.uniform()};
        auto s = d.sample(u);
        ASSERT_GT(s.pdf, 0);
        ASSERT_NEAR(d.pdf(s.p), s.pdf, 1e-5f);
        Vec2 back = d.invert(s.p);
        ASSERT_NEAR(back.x, u.x, 1e-5f);
        ASSERT_NEAR(back.y, u.y, 1e-5f);
    }
}

TEST(PiecewiseConstant2D, AllZeroIsUniform) {
    const std::vector<float> zero(16);
    PiecewiseConstant2D d(zero, 4, 4);
    EXPECT_EQ(d.integral(), 0);
    EXPECT_NEAR(d.pdf({0.1f, 0.9f}), 1, 1e-6f);
    EXPECT_NEAR(d.sample({0.3f, 0.6f}).p.x, 0.3f, 1e-6f);
}

TEST(AliasTable, ChoosesInProportion) {
    const std::array<float, 6> weights{1, 0, 5, 2, 0.5f, -3};
    AliasTable table(weights);
    std::array<double, 6> counts{}, expected{};
    std::vector<double> reused(16), reused_expected(16, 200000 / 16.0);
    Rng rng(4);
    for (int i = 0; i < 200000; ++i) {
        auto s = table.sample(rng.uniform());
        counts[s.index] += 1;
        ASSERT_TRUE(s.u >= 0 && s.u < 1);
        reused[static_cast<std::size_t>(s.u * 16)] += 1;
        ASSERT_EQ(s.probability, table.probability(s.index));
    }
    for (std::size_t i = 0; i < 6; ++i) expected[i] = 200000 * static_cast<double>(table.probability(i));
    EXPECT_NEAR(table.probability(2), 5 / 8.5f, 1e-6f);
    EXPECT_EQ(table.probability(5), 0);
    EXPECT_GT(testing_support::chi_square_test(counts, expected).p_value, p_threshold);
    EXPECT_GT(testing_support::chi_square_test(reused, reused_expected).p_value, p_threshold);
}

TEST(AliasTable, AllZeroIsUniformAndEmptyIsEmpty) {
    const std::array<float, 3> zero{};
    AliasTable table(zero);
    EXPECT_NEAR(table.probability(1), 1 / 3.0f, 1e-6f);
    EXPECT_EQ(table.sample(0.5f).index, 1u);
    EXPECT_TRUE(AliasTable().empty());
}

TEST(Special, ErfInvUndoesErf) {
    for (float y = -0.999f; y < 1; y += 0.037f)
        EXPECT_NEAR(std::erf(static_cast<double>(erf_inv(y))), y, 3e-7);
    EXPECT_EQ(erf_inv(0), 0);
    EXPECT_TRUE(std::isfinite(erf_inv(1)) && std::isfinite(erf_inv(-1)));
}

TEST(Special, GaussianIntegral) {
    EXPECT_NEAR(gaussian_integral(-1, 1), 0.6826895f, 1e-6f);
    EXPECT_NEAR(gaussian_integral(-10, 10, 2, 1.5f), 1, 1e-6f);
    EXPECT_NEAR(gaussian(0), 0.3989423f, 1e-6f);
}

TEST(Special, FilterCurves) {
    EXPECT_EQ(sinc(0), 1);
    EXPECT_NEAR(sinc(1), 0, 1e-7f);
    EXPECT_NEAR(sinc(0.5f), 0.6366198f, 1e-6f);
    EXPECT_NEAR(sinc(1e-5f), 1, 1e-6f);
    EXPECT_EQ(windowed_sinc(5, 4, 3), 0);
    // Mitchell and Netravali's pieces meet, with equal slopes, and shifted copies add up to 1.
    const float third = 1 / 3.0f;
    EXPECT_NEAR(mitchell(1 - 1e-4f, third, third), mitchell(1 + 1e-4f, third, third), 2e-4f);
    EXPECT_EQ(mitchell(2, third, third), 0);
    for (float x : {0.0f, 0.2f, 0.5f, 0.9f}) {
        float sum = 0;
        for (int i = -2; i <= 2; ++i) sum += mitchell(x + static_cast<float>(i), third, third);
        EXPECT_NEAR(sum, 1, 1e-6f);
    }
}

} // namespace
} // namespace alhazen
