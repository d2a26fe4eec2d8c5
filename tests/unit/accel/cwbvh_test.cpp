/// Compressed nodes: boxes that contain what they stood for, and children in their octants.

#include "accel/layout/compressed.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/unit/accel/support.h"

namespace alhazen {
namespace {

using namespace accel_test;

Tree tree_of(const Triangles& t, std::uint32_t leaf_size) {
    return sah_builder().build(t, t.boxes(), {1, leaf_size});
}

Bounds3 decoded(const CompressedNode& node, int slot) {
    Bounds3 box;
    for (int axis = 0; axis < 3; ++axis) {
        box.lo[axis] = node.plane(0, axis, slot);
        box.hi[axis] = node.plane(1, axis, slot);
    }
    return box;
}

struct Checker {
    const CompressedLayout& layout;
    std::span<const Bounds3> boxes;
    std::vector<int> seen;
    double looseness = 0; // the most steps by which a leaf's box is too large

    // Returns the box of all primitives below the node.
    Bounds3 check(std::uint32_t number) {
        const CompressedNode& node = layout.nodes[number];
        Bounds3 whole;
        for (int slot = 0; slot < 8; ++slot) {
            const unsigned meta = node.meta[slot];
            if (meta == 0) continue;
            Bounds3 box;
            if (node.is_inner(slot)) {
                EXPECT_EQ(meta, 32u | (24u + static_cast<unsigned>(slot)));
                EXPECT_GT(node.child(slot), number);
                box = check(node.child(slot));
            } else {
                const unsigned count = static_cast<unsigned>(std::popcount(meta >> 5));
                EXPECT_EQ(meta >> 5, (1u << count) - 1);
                EXPECT_LE((meta & 31) + count, 24u);
                for (unsigned k = 0; k < count; ++k) {
                    const std::uint32_t place = node.first_primitive + (meta & 31) + k;
                    ++seen[place];
                    box.extend(boxes[layout.order[place]]);
                }
                for (int axis = 0; axis < 3; ++axis) {
                    const double excess = static_cast<double>(box.lo[axis] - decoded(node, slot).lo[axis]);
                    looseness = std::max(looseness, excess / static_cast<double>(node.step(axis)));
                }
            }
            const Bounds3 stored = decoded(node, slot);
            EXPECT_TRUE(stored.contains(box.lo) && stored.contains(box.hi)) << number << " " << slot;
            whole.extend(box);
        }
        return whole;
    }
};

TEST(CompressedLayout, BoxesContainTheirPrimitivesAtEveryScaleAndPlace) {
    for (float scale : {1e-30f, 1e-6f, 1.0f, 1e6f, 1e30f})
        for (float offset : {0.0f, 1000.0f}) {
            Triangles t = random_triangles(400, scale, 0.1f * scale, 1);
            for (Corners& c : t.list)
                for (Vec3* p : {&c.a, &c.b, &c.c}) *p += Vec3{1, -2, 0.5f} * (offset * scale);
            auto boxes = t.boxes();
            CompressedLayout layout(tree_of(t, 1));
            Checker checker{layout, boxes, std::vector<int>(layout.order.size(), 0)};
            checker.check(0);
            for (int count : checker.seen) EXPECT_EQ(count, 1);
            // One step for rounding down, and one where far from the origin planes fall between floats.
            EXPECT_LE(checker.looseness, 2.001);
        }
}

// Sides so near a step of the grid that even doubles cannot tell the difference.
TEST(CompressedLayout, BoxesThatEndJustBesideAStepStayInside) {
    const float tiny = 0x1p-80f;
    Tree tree;
    tree.nodes = {{{{-1, -1, -1}, {1, 1, 1}}, 2, 0},
                  {{{-1, -1, -1}, {tiny, tiny, tiny}}, 0, 2},
                  {{{-tiny, -tiny, -tiny}, {1, 1, 1}}, 2, 2}};
    tree.order = {0, 1, 2, 3};
    CompressedLayout layout(tree);
    ASSERT_EQ(layout.nodes.size(), 1u);
    int found = 0;
    for (int slot = 0; slot < 8; ++slot) {
        if (layout.nodes[0].meta[slot] == 0) continue;
        const Bounds3 box = decoded(layout.nodes[0], slot);
        const bool is_lower = layout.order[layout.nodes[0].meta[slot] & 31] < 2;
        const Bounds3& original = tree.nodes[is_lower ? 1 : 2].bounds;
        EXPECT_TRUE(box.contains(original.lo) && box.contains(original.hi));
        ++found;
    }
    EXPECT_EQ(found, 2);
}

TEST(CompressedLayout, GridsAreAsFineAsTheyCanBe) {
    Triangles t = random_triangles(1000, 1, 0.1f, 2);
    CompressedLayout layout(tree_of(t, 1));
    for (const CompressedNode& node : layout.nodes)
        for (int axis = 0; axis < 3; ++axis) {
            int most = 0;
            for (int slot = 0; slot < 8; ++slot)
                if (node.meta[slot] != 0) most = std::max(most, int{node.planes[1][axis][slot]});
            EXPECT_GE(most, 127);
        }
}

TEST(CompressedLayout, FlatBoxesStayFlat) {
    Triangles t = random_triangles(100, 1, 0.1f, 3);
    Tree tree = tree_of(t, 1);
    for (Tree::Node& n : tree.nodes) n.bounds.lo.z = n.bounds.hi.z = 0.25f;
    CompressedLayout layout(tree);
    for (const CompressedNode& node : layout.nodes)
        for (int slot = 0; slot < 8; ++slot) {
            if (node.meta[slot] == 0) continue;
            EXPECT_EQ(node.plane(0, 2, slot), 0.25f);
            EXPECT_EQ(node.plane(1, 2, slot), 0.25f);
        }
}

TEST(CompressedLayout, OrderIsARearrangement) {
    Triangles t = random_triangles(777, 1, 0.1f, 4);
    for (std::uint32_t leaf_size : {1u, 3u, 8u}) {
        CompressedLayout layout(tree_of(t, leaf_size));
        std::vector<std::uint32_t> sorted = layout.order, expected(777);
        std::sort(sorted.begin(), sorted.end());
        std::iota(expected.begin(), expected.end(), 0u);
        EXPECT_EQ(sorted, expected);
    }
}

double cost_of(std::span<const WideChild> children, std::span<const int> slot_of) {
    Bounds3 box;
    for (const WideChild& c : children) box.extend(c.bounds);
    double cost = 0;
    for (std::size_t i = 0; i < children.size(); ++i) {
        Vec3d d = Vec3d(children[i].bounds.centroid()) - Vec3d(box.centroid());
        for (int axis = 0; axis < 3; ++axis) cost += slot_of[i] >> axis & 1 ? -d[axis] : d[axis];
    }
    return cost;
}

TEST(Slots, ChildrenInTheCornersOfACubeSitInTheirOctants) {
    std::vector<WideChild> children;
    for (int corner : {5, 2, 7, 0, 3, 6, 1, 4}) {
        Vec3 p{corner & 1 ? 1.0f : 0.0f, corner & 2 ? 1.0f : 0.0f, corner & 4 ? 1.0f : 0.0f};
        children.push_back({{p, p + Vec3{0.5f, 0.5f, 0.5f}}, {0, 1}});
    }
    auto slot_of = assign_slots(children);
    EXPECT_EQ(slot_of, (std::array<int, 8>{5, 2, 7, 0, 3, 6, 1, 4}));
    // A ray towards +++ visits slot s ^ 7 in falling order: the corner at the origin first.
    EXPECT_EQ(slot_of[3] ^ 7, 7);
}

TEST(Slots, NoOtherAssignmentIsBetter) {
    Rng rng(5);
    for (std::size_t n = 1; n <= 5; ++n)
        for (int repeat = 0; repeat < 10; ++repeat) {
            std::vector<WideChild> children;
            for (std::size_t i = 0; i < n; ++i) {
                Vec3 p = random_point(rng, 1);
                children.push_back({{p, p + Vec3{0.1f, 0.1f, 0.1f}}, {0, 1}});
            }
            auto found = assign_slots(children);
            std::array<int, 8> slots{0, 1, 2, 3, 4, 5, 6, 7};
            double least = 1e30;
            do least = std::min(least, cost_of(children, slots));
            while (std::next_permutation(slots.begin(), slots.end()));
            EXPECT_NEAR(cost_of(children, found), least, 1e-6);
            for (std::size_t i = 0; i < n; ++i)
                for (std::size_t j = 0; j < i; ++j) EXPECT_NE(found[i], found[j]);
        }
}

TEST(CompressedWalk, KeepsAGroupALevel) {
    Triangles t = random_triangles(20000, 1, 0.05f, 6);
    Tree tree = tree_of(t, 1);
    auto structure = cwbvh_walk().make(t, tree, {});
    TriangleTests tests(t);
    Rng rng(7);
    WalkCounts counts;
    for (int i = 0; i < 300; ++i) structure->count(Query::closest, random_ray(t, 1, rng), tests, counts);
    EXPECT_GT(counts.max_stack, 0u);
    EXPECT_LE(counts.max_stack, static_cast<std::uint32_t>(structure->stats().depth));
    // 80 bytes a node and the primitives' copies.
    auto binary = stack_walk().make(t, tree, {});
    EXPECT_LT(structure->stats().nodes * 80 * 3, binary->stats().nodes * 64);
}

// A ray that meets what is near first visits little more than one that knows beforehand where it ends.
TEST(CompressedWalk, NearChildrenComeFirst) {
    Triangles t = random_triangles(20000, 1, 0.1f, 8);
    Tree tree = tree_of(t, 1);
    auto structure = cwbvh_walk().make(t, tree, {});
    TriangleTests tests(t);
    Rng rng(9);
    WalkCounts open, closed;
    for (int i = 0; i < 500; ++i) {
        Ray ray{random_point(rng, 0.3f), random_point(rng, 1)};
        Intersection hit;
        if (!structure->closest(ray, hit, tests)) continue;
        structure->count(Query::closest, ray, tests, open);
        ray.tmax = next_up(hit.t);
        structure->count(Query::closest, ray, tests, closed);
    }
    EXPECT_LT(open.nodes * 10, closed.nodes * 15) << open.nodes << " " << closed.nodes;
    EXPECT_LT(open.leaves * 10, closed.leaves * 15) << open.leaves << " " << closed.leaves;
}

TEST(CompressedWalk, TakesLeavesLargerThanASlot) {
    Triangles t = random_triangles(300, 1, 0.3f, 10);
    auto structure = cwbvh_walk().make(t, tree_of(t, 8), {});
    TriangleTests tests(t);
    Rng rng(11);
    for (int i = 0; i < 500; ++i) {
        Ray ray = random_ray(t, 1, rng);
        Intersection hit, expected = t.brute_force(ray);
        structure->closest(ray, hit, tests);
        ASSERT_EQ(hit.primitive, expected.primitive);
        ASSERT_EQ(hit.t, expected.t);
    }
}

} // namespace
} // namespace alhazen
