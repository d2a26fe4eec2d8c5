/// Rays in flight together: batches of any size give each ray the hit it has alone.

#include <gtest/gtest.h>

#include "accel/layout/multi_node.h"
#include "tests/unit/accel/support.h"

namespace alhazen {
namespace {

using namespace accel_test;

TEST(Guthe, BatchesOfAnySizeAnswerEachRay) {
    Triangles t = random_triangles(2000, 1, 0.2f, 1);
    auto structure = guthe_walk().make(t, sah_builder().build(t, t.boxes(), {}), {});
    TriangleTests tests(t);
    Rng rng(2);
    for (std::size_t size : {0u, 1u, 2u, 7u, 8u, 9u, 100u}) {
        std::vector<Ray> rays;
        for (std::size_t i = 0; i < size; ++i) {
            rays.push_back(random_ray(t, 1, rng));
            // Rays that cannot be traced lie between the others, and at the ends.
            if (i % 3 == 0) rays.back().d = {};
        }
        std::vector<Intersection> hits(size);
        std::vector<std::uint8_t> blocked(size + 1, 7);
        structure->closest(rays, hits, tests);
        structure->any(rays, blocked, tests);
        for (std::size_t i = 0; i < size; ++i) {
            Intersection alone;
            EXPECT_EQ(structure->closest(rays[i], alone, tests), hits[i].found());
            EXPECT_EQ(alone.primitive, hits[i].primitive);
            EXPECT_EQ(alone.t, hits[i].t);
            EXPECT_EQ(blocked[i], alone.found());
        }
        EXPECT_EQ(blocked[size], 7);
    }
}

// Tests are told which ray of the batch asks.
struct NumberedTests final : PrimitiveTests {
    const Triangles& triangles;
    std::span<const Ray> rays;

    NumberedTests(const Triangles& t, std::span<const Ray> r) : triangles(t), rays(r) {}
    bool intersect(const Question& q, Intersection& hit) override {
        EXPECT_EQ(q.ray.o, rays[q.ray_index].o);
        EXPECT_EQ(q.ray.d, rays[q.ray_index].d);
        return triangles.meets(q.ray, q.primitive, hit);
    }
    bool accept(const Question&, const Intersection&) override { return true; }
};

TEST(Guthe, TestsAreToldWhichRayAsks) {
    Triangles t = random_triangles(300, 1, 0.3f, 3);
    t.kinds.assign(t.list.size(), PrimitiveKind::custom);
    auto structure = guthe_walk().make(t, sah_builder().build(t, t.boxes(), {}), {});
    Rng rng(4);
    std::vector<Ray> rays;
    for (int i = 0; i < 50; ++i) rays.push_back(random_ray(t, 1, rng));
    NumberedTests tests(t, rays);
    std::vector<Intersection> hits(rays.size());
    structure->closest(rays, hits, tests);
    std::vector<std::uint8_t> blocked(rays.size());
    structure->any(rays, blocked, tests);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        EXPECT_EQ(hits[i].primitive, t.brute_force(rays[i]).primitive);
        EXPECT_EQ(blocked[i], hits[i].found());
    }
}

TEST(Guthe, VisitsFewerNodesThanBinaryAndKeepsThreeAFloorAtMost) {
    Triangles t = random_triangles(5000, 1, 0.03f, 5);
    Tree tree = sah_builder().build(t, t.boxes(), {});
    auto wide = guthe_walk().make(t, tree, {}), binary = stack_walk().make(t, tree, {});
    TriangleTests tests(t);
    Rng rng(6);
    WalkCounts a, b;
    for (int i = 0; i < 300; ++i) {
        Ray ray = random_ray(t, 1, rng);
        wide->count(Query::closest, ray, tests, a);
        binary->count(Query::closest, ray, tests, b);
    }
    EXPECT_LT(a.nodes * 3, b.nodes * 2);
    EXPECT_LE(a.max_stack, static_cast<std::uint32_t>(3 * wide->stats().depth));
}

TEST(MultiNode, ShorteningARayTakesChildrenOffTheEnd) {
    Triangles t = random_triangles(500, 1, 0.5f, 4);
    MultiLayout<4> layout(sah_builder().build(t, t.boxes(), {}));
    Rng rng(5);
    for (int i = 0; i < 500; ++i) {
        Ray ray = random_ray(t, 1, rng);
        MultiTest<4> test(BoxRay(ray, {{-2, -2, -2}, {2, 2, 2}}));
        const MultiNode<4>& node = layout.nodes[rng.below(static_cast<std::uint32_t>(layout.nodes.size()))];
        const auto all = test(node, infinity), some = test(node, rng.uniform() * 4);
        ASSERT_LE(some.count, all.count);
        for (int k = 0; k < some.count; ++k) EXPECT_EQ(some.list[k].child, all.list[k].child);
        for (int k = 1; k < all.count; ++k) {
            EXPECT_LE(all.list[k - 1].t, all.list[k].t);
            if (all.list[k - 1].t == all.list[k].t) {
                EXPECT_LT(all.list[k - 1].child, all.list[k].child);
            }
        }
    }
}

TEST(MultiNode, ChildrenThatAreNotThereAreNeverHit) {
    Triangles t = random_triangles(2, 1, 0.5f, 6);
    MultiLayout<4> layout(collapse(sah_builder().build(t, t.boxes(), {1, 1}), costs_by_primitive,
                                   {.width = 4, .leaf_size = 1}));
    ASSERT_EQ(layout.nodes.size(), 1u);
    // Directions so short that all boxes are visited.
    Ray ray{{0, 0, 0}, {1e-38f, 0, 0}};
    const auto hits = MultiTest<4>(BoxRay(ray, {{-2, -2, -2}, {2, 2, 2}}))(layout.nodes[0], infinity);
    EXPECT_EQ(hits.count, 2);
}

} // namespace
} // namespace alhazen
