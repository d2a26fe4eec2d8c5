#include "math/bilinear_tables.h"

#include <gtest/gtest.h>

#include "tests/support/density_test.h"

namespace alhazen {
namespace {

using testing_support::chi_square_2d;
using testing_support::p_threshold;

// Two tables of 4 x 3, the first with empty cells.
const std::vector<float> heights{0, 0, 1, 2, 0, 0, 3, 1, 0, 0, 0, 5, 4, 1, 1, 2, 0, 3, 3, 1, 2, 2, 0, 1};

TableBlend blend_of(float second) {
    TableBlend blend;
    blend.add(0, 1 - second);
    blend.add(1, second);
    return blend;
}

TEST(BilinearTables, PlacesOnAnAxis) {
    const std::vector<float> nodes{1, 2, 4};
    auto at = [&](float x) { return locate(nodes, x); };
    EXPECT_EQ(at(0).index, 0u);
    EXPECT_EQ(at(0).fraction, 0);
    EXPECT_EQ(at(1.5f).fraction, 0.5f);
    EXPECT_EQ(at(2).index, 1u);
    EXPECT_EQ(at(3).index, 1u);
    EXPECT_EQ(at(3).fraction, 0.5f);
    EXPECT_EQ(at(9).index, 1u);
    EXPECT_EQ(at(9).fraction, 1);
    EXPECT_EQ(locate(std::vector<float>{7}, 3).fraction, 0);
}

TEST(BilinearTables, BlendsTheFourAround) {
    const TableBlend blend = blend_around({1, 0.25f}, {2, 0.5f}, 5);
    ASSERT_EQ(blend.count, 4);
    EXPECT_EQ(blend.table, (std::array<std::size_t, 4>{7, 8, 12, 13}));
    EXPECT_EQ(blend.weight, (std::array{0.375f, 0.375f, 0.125f, 0.125f}));
    // On the last node there is nothing beyond.
    EXPECT_EQ(blend_around({0, 0}, {3, 1}, 5).count, 1);
}

TEST(BilinearTables, IsBilinearBetweenNodes) {
    const BilinearTables t({1, 2, 4, 3, 5, 7}, 3, 2);
    EXPECT_EQ(t.count(), 1u);
    EXPECT_EQ(t.eval({0, 0}), 1);
    EXPECT_EQ(t.eval({0.5f, 0}), 2);
    EXPECT_EQ(t.eval({1, 1}), 7);
    EXPECT_EQ(t.eval({0.25f, 0.5f}), (1 + 2 + 3 + 5) / 4.0f);
    EXPECT_EQ(t.eval({-3, 8}), 3);
}

TEST(BilinearDensities, SamplesItsDensity) {
    const BilinearDensities d(heights, 4, 3);
    for (float second : {0.0f, 0.3f, 1.0f}) {
        const TableBlend blend = blend_of(second);
        EXPECT_GT(chi_square_2d([&](Vec2 u) { return d.sample(u, blend).p; },
                                [&](Vec2 p) { return d.pdf(p, blend); }, {}, 200000, 12),
                  p_threshold)
            << second;
    }
}

TEST(BilinearDensities, IsInverted) {
    const BilinearDensities d(heights, 4, 3);
    Rng rng(1);
    for (float second : {0.0f, 0.6f})
        for (int i = 0; i < 2000; ++i) {
            const float x = rng.uniform();
            const Vec2 u{x, rng.uniform()};
            const auto s = d.sample(u, blend_of(second));
            ASSERT_GT(s.pdf, 0);
            const auto back = d.invert(s.p, blend_of(second));
            ASSERT_NEAR(back.p.x, u.x, 2e-5f);
            ASSERT_NEAR(back.p.y, u.y, 2e-5f);
            ASSERT_NEAR(back.pdf, s.pdf, 2e-4f * s.pdf + 1e-5f);
            ASSERT_NEAR(d.pdf(s.p, blend_of(second)), s.pdf, 2e-4f * s.pdf + 1e-5f);
        }
}

TEST(BilinearDensities, AllZeroIsUniformAndCornersAreSafe) {
    const BilinearDensities flat(std::vector<float>(12, 0.0f), 4, 3), d(heights, 4, 3);
    const TableBlend blend = blend_of(0);
    EXPECT_NEAR(flat.pdf({0.3f, 0.9f}, blend), 1, 1e-6f);
    EXPECT_NEAR(flat.sample({0.3f, 0.9f}, blend).p.x, 0.3f, 1e-6f);
    for (float x : {0.0f, one_minus_epsilon})
        for (float y : {0.0f, one_minus_epsilon}) {
            const auto s = d.sample({x, y}, blend);
            EXPECT_TRUE(s.p.x >= 0 && s.p.x <= 1 && s.p.y >= 0 && s.p.y <= 1);
            EXPECT_TRUE(std::isfinite(s.pdf) && s.pdf >= 0);
        }
}

} // namespace
} // namespace alhazen
