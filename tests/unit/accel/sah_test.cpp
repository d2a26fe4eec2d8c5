#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstring>

#include "accel/layout/binary.h"
#include "tests/unit/accel/check_tree.h"
#include "tests/unit/accel/support.h"

namespace alhazen {
namespace {

using namespace accel_test;

Tree build_sah(const std::vector<Bounds3>& boxes, const BuildOptions& options = {}) {
    return sah_builder().build(Triangles{}, boxes, options);
}

TEST(Sah, BuildsAProperTree) {
    for (std::size_t n : {1u, 2u, 3u, 5u, 9u, 1000u, 50000u}) {
        auto boxes = random_triangles(n, 1, 0.01f, n).boxes();
        check_tree_of_boxes(build_sah(boxes), boxes);
    }
}

TEST(Sah, CoincidentBoxesAreHalved) {
    std::vector<Bounds3> boxes(10000, Bounds3{{1, 2, 3}, {4, 5, 6}});
    EXPECT_LE(check_tree_of_boxes(build_sah(boxes), boxes), 14);
    // Same centroids, different sizes.
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        float r = static_cast<float>(i);
        boxes[i] = {{-r, -r, -r}, {r, r, r}};
    }
    check_tree_of_boxes(build_sah(boxes), boxes);
}

TEST(Sah, DepthStaysBoundedForGeometricSequences) {
    // Each is so much larger than all before that the heuristic splits one off at a time.
    std::vector<Bounds3> boxes;
    for (int copy = 0; copy < 20; ++copy)
        for (int i = -120; i < 120; ++i) {
            float p = std::ldexp(1.0f, i);
            boxes.push_back({{p, p, p}, {p * 1.01f, p * 1.01f, p * 1.01f}});
        }
    check_tree_of_boxes(build_sah(boxes), boxes);
}

TEST(Sah, HugeAndTinyNumbersDoNotUpsetIt) {
    std::vector<Bounds3> boxes;
    Rng rng(3);
    for (int i = 0; i < 2000; ++i) {
        Vec3 p = random_point(rng, 1) * (i % 2 ? 3.3e38f : 1e-42f);
        boxes.push_back({p, p});
    }
    boxes.push_back({{-3.4e38f, -3.4e38f, -3.4e38f}, {3.4e38f, 3.4e38f, 3.4e38f}});
    check_tree_of_boxes(build_sah(boxes), boxes);
}

TEST(Sah, OptionsMayAskForNoMoreThanTheTreeAllows) {
    auto boxes = random_triangles(1000, 1, 1, 4).boxes();
    check_tree_of_boxes(build_sah(boxes, {.node_cost = 1000, .leaf_size = 1000}), boxes);
    check_tree_of_boxes(build_sah(boxes, {.node_cost = 0, .leaf_size = 1}), boxes);
}

TEST(Sah, ALeafCostsAsManyTestsAsBlocks) {
    // Four pairs of cubes, far apart.
    std::vector<Bounds3> boxes;
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 2; ++k) {
            Vec3 p{static_cast<float>(100 * i), static_cast<float>(k), 0};
            boxes.push_back({p, p + Vec3(1)});
        }
    // One by one, the pairs are worth a node; tested eight at once, a leaf of all costs 1 and no tree less
    // than its node_cost.
    Tree single = build_sah(boxes, {.node_cost = 0.9f, .leaf_size = 8});
    EXPECT_EQ(stats_of(single).leaves, 4u);
    check_tree_of_boxes(single, boxes);
    Tree blocks = build_sah(boxes, {.node_cost = 1, .leaf_size = 8, .block = 8});
    EXPECT_EQ(stats_of(blocks).leaves, 1u);
    EXPECT_EQ(stats_of(blocks, 1, 8).sah_cost, 1);
    // Cheap nodes pay off again.
    Tree cheap = build_sah(boxes, {.node_cost = 0.3f, .leaf_size = 8, .block = 8});
    EXPECT_EQ(stats_of(cheap).leaves, 4u);
}

// The heuristic's best tree from the top down: every split of the sorted centres is tried.
double cost_by_sweep(std::vector<Bounds3> boxes, float root_area) {
    Bounds3 all;
    for (const Bounds3& b : boxes) all.extend(b);
    double area = static_cast<double>(all.half_area() / root_area),
           leaf = area * static_cast<double>(boxes.size());
    if (boxes.size() == 1) return leaf;
    float best = infinity;
    std::vector<Bounds3> best_order;
    std::size_t best_left = 0;
    for (int axis = 0; axis < 3; ++axis) {
        std::stable_sort(boxes.begin(), boxes.end(), [axis](const Bounds3& a, const Bounds3& b) {
            return a.lo[axis] + a.hi[axis] < b.lo[axis] + b.hi[axis];
        });
        std::vector<float> right(boxes.size() + 1, 0);
        Bounds3 side;
        for (std::size_t i = boxes.size(); i-- > 1;) {
            side.extend(boxes[i]);
            right[i] = side.half_area() * static_cast<float>(boxes.size() - i);
        }
        side = {};
        bool is_better = false;
        for (std::size_t i = 1; i < boxes.size(); ++i) {
            side.extend(boxes[i - 1]);
            float cost = side.half_area() * static_cast<float>(i) + right[i];
            if (cost < best) best = cost, best_left = i, is_better = true;
        }
        if (is_better) best_order = boxes;
    }
    auto middle = best_order.begin() + static_cast<std::ptrdiff_t>(best_left);
    bool is_leaf = boxes.size() <= 4 && leaf <= area + static_cast<double>(best / root_area);
    return is_leaf ? leaf
                   : area + cost_by_sweep({best_order.begin(), middle}, root_area) +
                         cost_by_sweep({middle, best_order.end()}, root_area);
}

TEST(Sah, CostsNoMoreThanTryingEverySplit) {
    for (float size : {0.01f, 0.1f, 0.5f}) {
        auto boxes = random_triangles(3000, 1, size, 31).boxes();
        Tree tree = build_sah(boxes);
        double cost = cost_by_sweep(boxes, tree.nodes[0].bounds.half_area());
        EXPECT_LT(stats_of(tree).sah_cost, 1.03 * cost) << size;
    }
}

TEST(Sah, EmptyBoxesAreLeftOut) {
    auto boxes = random_triangles(50000, 1, 0.01f, 32).boxes();
    for (std::size_t i = 0; i < boxes.size(); ++i)
        if (i % 3 == 0 || (i > 20000 && i < 40000)) boxes[i] = {};
    check_tree_of_boxes(build_sah(boxes), boxes);
    std::vector<Bounds3> empty(40000);
    EXPECT_TRUE(build_sah(empty).nodes.empty());
}

TEST(Sah, TheNumberOfThreadsDoesNotChangeABit) {
    auto boxes = random_triangles(120000, 1, 0.01f, 5).boxes();
    for (std::size_t i = 0; i < boxes.size(); i += 7) boxes[i] = boxes[i / 2]; // some coincide
    for (std::size_t i = 3; i < boxes.size(); i += 11) boxes[i].lo.x = -0.0f, boxes[i].hi.x = 0.0f;
    Tree first;
    for (int threads : {1, 2, 3}) {
        tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 3);
        tbb::task_arena arena(threads);
        Tree tree;
        arena.execute([&] { tree = build_sah(boxes); });
        if (threads == 1) first = tree;
        ASSERT_EQ(tree.nodes.size(), first.nodes.size());
        EXPECT_EQ(std::memcmp(tree.nodes.data(), first.nodes.data(), tree.nodes.size() * sizeof(Tree::Node)),
                  0);
        EXPECT_EQ(tree.order, first.order);
    }
}

TEST(Binary, NodesHoldTheirChildren) {
    auto boxes = random_triangles(1000, 1, 0.1f, 6).boxes();
    Tree tree = build_sah(boxes);
    BinaryLayout layout(tree);
    TreeStats stats = stats_of(tree);
    EXPECT_EQ(layout.nodes.size(), stats.leaves - 1);
    EXPECT_EQ(layout.stats().bytes, layout.nodes.size() * 64);
    EXPECT_EQ(layout.depth, stats.depth);
    std::size_t referred = layout.root.count;
    for (const BinaryNode& n : layout.nodes) referred += n.count[0] + n.count[1];
    EXPECT_EQ(referred, boxes.size());
}

TEST(TreeStats, OfATreeByHand) {
    // Two unit cubes with a gap of one between them: root 3 x 1 x 1 (half area 7), children 3 each.
    Triangles none;
    std::vector<Bounds3> boxes{{{0, 0, 0}, {1, 1, 1}}, {{2, 0, 0}, {3, 1, 1}}};
    Tree tree = build_sah(boxes, {.leaf_size = 1});
    TreeStats stats = stats_of(tree, 2.0f);
    EXPECT_EQ(stats.nodes, 3u);
    EXPECT_EQ(stats.leaves, 2u);
    EXPECT_EQ(stats.references, 2u);
    EXPECT_EQ(stats.depth, 1);
    EXPECT_NEAR(stats.sah_cost, (2 * 7 + 3 + 3) / 7.0, 1e-6);
}

TEST(TreeStats, EndPointOverlapCountsSurfaceOfOthers) {
    // Two unit squares in the plane z = 0, the second half inside the first's box: of the points on both, the
    // overlapping half of each lies in the other's leaf; inner nodes hold everything.
    Triangles t({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{5, 5, 0}, {6, 5, 0}, {5, 6, 0}}});
    Tree tree = build_sah(t.boxes(), {.leaf_size = 1});
    EXPECT_EQ(end_point_overlap(tree, t), 0);
    // The same triangle twice: every point lies in the other's leaf, which holds one primitive.
    t.list[1] = t.list[0];
    tree = build_sah(t.boxes(), {.leaf_size = 1});
    EXPECT_NEAR(end_point_overlap(tree, t), 1, 1e-9);
}

TEST(Refit, BoxesFollowThePrimitives) {
    Triangles t = random_triangles(20000, 1, 0.1f, 8);
    Tree tree = build_sah(t.boxes());
    for (Corners& c : t.list)
        for (Vec3* p : {&c.a, &c.b, &c.c}) *p = Vec3{p->y, p->x * 2, p->z + 1};
    EXPECT_TRUE(refit(tree, t.boxes()));
    check_tree_of_boxes(tree, t.boxes());
    Bounds3 all;
    for (const Bounds3& box : t.boxes()) all.extend(box);
    EXPECT_EQ(tree.nodes[0].bounds.lo, all.lo);
    EXPECT_EQ(tree.nodes[0].bounds.hi, all.hi);
}

TEST(Refit, WhatCannotBeHitAnyMoreHasNoExtent) {
    Triangles t = random_triangles(100, 1, 0.1f, 9);
    Tree tree = build_sah(t.boxes(), {.leaf_size = 1});
    auto boxes = t.boxes();
    for (std::size_t i = 0; i < 50; ++i) boxes[i] = {};
    EXPECT_TRUE(refit(tree, boxes));
    for (const Tree::Node& n : tree.nodes) {
        EXPECT_FALSE(n.bounds.empty());
        if (!n.is_leaf()) continue;
        EXPECT_EQ(n.bounds.lo == n.bounds.hi, tree.order[n.first_or_right] < 50);
    }
}

TEST(Refit, RefusesWhatATreeOfOtherPrimitivesCannotFollow) {
    Triangles t = random_triangles(100, 1, 0.1f, 10);
    auto boxes = t.boxes(), fewer = boxes;
    fewer[7] = {};
    Tree tree = build_sah(fewer);
    const Bounds3 before = tree.nodes[0].bounds;
    EXPECT_FALSE(refit(tree, boxes));
    EXPECT_FALSE(refit(tree, std::vector<Bounds3>(100)));
    EXPECT_EQ(tree.nodes[0].bounds.lo, before.lo);
    EXPECT_EQ(tree.nodes[0].bounds.hi, before.hi);
    EXPECT_TRUE(refit(tree, fewer));
}

} // namespace
} // namespace alhazen
