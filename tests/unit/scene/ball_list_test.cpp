#include <gtest/gtest.h>

#include "base/hash.h"
#include "scene/ball_list.h"

namespace alhazen {
namespace {

using Balls = std::vector<BallList::Numbered>;

float distance(const Ball& ball, const Ray& ray) {
    auto t = static_cast<float>(ball.intersect(BallRay(ray)));
    return t > 0 && t < ray.tmax ? t : infinity;
}

Intersection nearest_one_by_one(const Balls& balls, const Ray& ray) {
    Intersection hit;
    for (const auto& [ball, primitive] : balls) {
        float t = distance(ball, ray);
        if (t < hit.t || (t < infinity && t == hit.t && primitive < hit.primitive))
            hit = {t, 0, 0, primitive, 0};
    }
    return hit;
}

void expect_same(const Balls& balls, const BallList& list, const Ray& ray) {
    Intersection expected = nearest_one_by_one(balls, ray), hit;
    list.closest(ray, hit);
    ASSERT_EQ(hit.primitive, expected.primitive);
    ASSERT_EQ(hit.t, expected.t);
    ASSERT_EQ(list.any(ray), expected.found());
}

// Small ones, one twice, one around all and a floor below all, in an order that has nothing to do with size.
Balls some_balls(double scale, std::size_t count, Rng& rng) {
    auto number = [&] { return (2 * static_cast<double>(rng.uniform()) - 1) * scale; };
    Balls balls{{{{0, -400 * scale, 0}, 399 * scale}, 1}, {{{0, 0, 0}, 30 * scale}, 7}};
    while (balls.size() < count) {
        Ball ball{{3 * number(), 3 * number(), 3 * number()}, std::abs(number())};
        auto next = static_cast<std::uint32_t>(10 + 3 * balls.size());
        balls.push_back({ball, next + 1});
        balls.push_back({ball, next});
    }
    return balls;
}

Vec3 random_point(Rng& rng, float size) {
    return Vec3{2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 2 * rng.uniform() - 1} * size;
}

TEST(BallList, AnswersAsTestingOneByOneDoes) {
    for (int lanes : {2, BallList::most_lanes()})
        for (double scale : {1e-6, 1.0, 1e6})
            for (std::size_t count : {2u, 4u, 6u, 10u, 24u}) {
                Rng rng(count);
                Balls balls = some_balls(scale, count, rng);
                BallList list(balls, lanes);
                const auto size = static_cast<float>(scale);
                int hits = 0;
                for (int i = 0; i < 4000; ++i) {
                    Ray ray{random_point(rng, 5 * size), random_point(rng, i % 3 == 0 ? 1e-3f : 2)};
                    expect_same(balls, list, ray);
                    Intersection hit = nearest_one_by_one(balls, ray);
                    if (!hit.found()) continue;
                    ++hits;
                    // Ending before, at and behind the nearest: by one step, and by far.
                    for (float end : {0.5f * hit.t, next_down(hit.t), hit.t, next_up(hit.t), 2 * hit.t}) {
                        ray.tmax = end;
                        expect_same(balls, list, ray);
                    }
                    // From the surface.
                    expect_same(balls, list, {ray.at(hit.t), random_point(rng, 1), infinity, 0});
                    if (HasFatalFailure()) return;
                }
                EXPECT_GT(hits, 1000);
            }
}

TEST(BallList, ReplacesOnlyWhatIsFartherOrHasAHigherNumber) {
    BallList list({{{{0, 0, 5}, 1}, 3}});
    Ray ray{{0, 0, 0}, {0, 0, 1}};
    auto after = [&](float t, std::uint32_t primitive) {
        Intersection hit{t, 0.25f, 0.5f, primitive, 0};
        list.closest(ray, hit);
        return hit;
    };
    EXPECT_EQ(after(4.5f, 9).primitive, 3u);
    EXPECT_EQ(after(4, 9).primitive, 3u);
    EXPECT_EQ(after(4, 2).primitive, 2u);
    EXPECT_EQ(after(3.5f, 9).primitive, 9u);
    EXPECT_EQ(after(3.5f, 9).v, 0.5f);
    EXPECT_EQ(after(4.5f, 9).v, 0);
}

TEST(BallList, RaysThatAreNotRaysHitNothing) {
    BallList list({{{{0, 0, 0}, 1}, 0}, {{{0, 0, 5}, 1}, 1}});
    const float nan = std::nanf("");
    for (Ray ray :
         {Ray{{0, 0, -5}, {0, 0, 0}}, Ray{{nan, 0, -5}, {0, 0, 1}}, Ray{{0, 0, -5}, {0, nan, 1}},
          Ray{{0, 0, -5}, {0, 0, infinity}}, Ray{{0, 0, -infinity}, {0, 0, 1}}, Ray{{0, 0, -5}, {0, 0, 1}, 0},
          Ray{{0, 0, -5}, {0, 0, 1}, -1}, Ray{{0, 0, -5}, {0, 0, 1}, nan}}) {
        Intersection hit;
        list.closest(ray, hit);
        EXPECT_FALSE(hit.found());
        EXPECT_FALSE(list.any(ray));
    }
    EXPECT_FALSE(BallList().any({{0, 0, -5}, {0, 0, 1}}));
}

} // namespace
} // namespace alhazen
