#include "integrators/ball_grid.h"

#include <gtest/gtest.h>

#include "base/threads.h"

namespace alhazen {
namespace {

Vec3 random_point(Rng& rng) {
    return (Vec3(rng.uniform(), rng.uniform(), rng.uniform()) - Vec3(0.5f)) * 4.0f;
}

std::vector<std::uint32_t> found_in(const BallGrid& grid, Vec3 p) {
    std::vector<std::uint32_t> found;
    grid.for_each(p, [&](std::uint32_t i) { found.push_back(i); });
    std::sort(found.begin(), found.end());
    return found;
}

// Of balls of all sizes, some of radius 0, exactly those that hold a point, each once.
TEST(BallGrid, FindsWhatAComparisonWithEachFinds) {
    Rng rng(1);
    std::vector<Ball3> balls;
    for (int i = 0; i < 3000; ++i)
        balls.push_back({random_point(rng), i % 10 == 0 ? 0 : 0.001f * std::exp(7 * rng.uniform())});
    for (int threads : {1, 3}) {
        BallGrid grid;
        with_threads(threads, [&] { grid.build(balls); });
        std::size_t pairs = 0;
        for (int k = 0; k < 2000; ++k) {
            const Vec3 p = k % 2 ? random_point(rng) : balls[static_cast<std::size_t>(k)].center;
            std::vector<std::uint32_t> expected;
            for (std::uint32_t i = 0; i < balls.size(); ++i)
                if (balls[i].radius > 0 && length_squared(p - balls[i].center) <= sqr(balls[i].radius))
                    expected.push_back(i);
            ASSERT_EQ(found_in(grid, p), expected);
            pairs += expected.size();
        }
        EXPECT_GT(pairs, 5000u);
    }
}

TEST(BallGrid, CanBeBuiltAgainAndBeEmpty) {
    BallGrid grid;
    EXPECT_TRUE(found_in(grid, {0, 0, 0}).empty());
    grid.build(std::vector<Ball3>{{{0, 0, 0}, 1}, {{5, 0, 0}, 1}});
    EXPECT_EQ(found_in(grid, {4.5f, 0, 0}), std::vector<std::uint32_t>{1});
    grid.build(std::vector<Ball3>{{{5, 0, 0}, 0}});
    EXPECT_TRUE(found_in(grid, {5, 0, 0}).empty());
    grid.build({});
    EXPECT_TRUE(found_in(grid, {5, 0, 0}).empty());
}

TEST(BallGrid, BearsExtremeSizesAndPlaces) {
    BallGrid grid;
    grid.build(std::vector<Ball3>{{{1e30f, -1e30f, 0}, 1e-20f}, {{0, 0, 0}, 1e19f}, {{0, 0, 0}, 1e-19f}});
    EXPECT_EQ(found_in(grid, {0, 0, 0}), (std::vector<std::uint32_t>{1, 2}));
}

} // namespace
} // namespace alhazen
