#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstring>

#include "accel/layout/binary.h"
#include "tests/unit/accel/support.h"

namespace alhazen {
namespace {

using namespace accel_test;

Tree build_sah(const std::vector<Bounds3>& boxes, const BuildOptions& options = {}) {
    return sah_builder().build(Triangles{}, boxes, options);
}

// Every primitive in one leaf, every box inside its parent's, and no path longer than promised. Returns the
// depth.
int check_tree(const Tree& tree, const std::vector<Bounds3>& boxes, std::size_t expected_primitives) {
    EXPECT_EQ(tree.order.size(), expected_primitives);
    if (tree.nodes.empty()) return 0;
    std::vector<int> seen(boxes.size(), 0);
    struct Visit {
        std::size_t node;
        int depth;
    };
    std::vector<Visit> stack{{0, 0}};
    std::size_t visited = 0;
    int deepest = 0;
    while (!stack.empty()) {
        auto [i, depth] = stack.back();
        stack.pop_back();
        ++visited;
        deepest = std::max(deepest, depth);
        const Tree::Node& n = tree.nodes[i];
        auto inside = [&](const Bounds3& b) { return n.bounds.contains(b.lo) && n.bounds.contains(b.hi); };
        if (n.is_leaf()) {
            EXPECT_LE(n.count, Tree::max_leaf_size);
            for (std::uint32_t k = 0; k < n.count; ++k) {
                std::uint32_t p = tree.order[n.first_or_right + k];
                ++seen[p];
                EXPECT_TRUE(inside(boxes[p]));
            }
            continue;
        }
        for (std::size_t child : {i + 1, static_cast<std::size_t>(n.first_or_right)}) {
            EXPECT_LT(child, tree.nodes.size());
            EXPECT_TRUE(inside(tree.nodes[child].bounds));
            stack.push_back({child, depth + 1});
        }
    }
    EXPECT_EQ(visited, tree.nodes.size());
    EXPECT_EQ(static_cast<std::size_t>(std::count(seen.begin(), seen.end(), 1)), expected_primitives);
    EXPECT_LE(deepest, Tree::max_depth);
    return deepest;
}

TEST(Sah, BuildsAProperTree) {
    for (std::size_t n : {1u, 2u, 3u, 5u, 9u, 1000u, 50000u}) {
        auto boxes = random_triangles(n, 1, 0.01f, n).boxes();
        check_tree(build_sah(boxes), boxes, n);
    }
}

TEST(Sah, CoincidentBoxesAreHalved) {
    std::vector<Bounds3> boxes(10000, Bounds3{{1, 2, 3}, {4, 5, 6}});
    EXPECT_LE(check_tree(build_sah(boxes), boxes, boxes.size()), 14);
    // Same centroids, different sizes.
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        float r = static_cast<float>(i);
        boxes[i] = {{-r, -r, -r}, {r, r, r}};
    }
    check_tree(build_sah(boxes), boxes, boxes.size());
}

TEST(Sah, DepthStaysBoundedForGeometricSequences) {
    // Each is so much larger than all before that the heuristic splits one off at a time.
    std::vector<Bounds3> boxes;
    for (int copy = 0; copy < 20; ++copy)
        for (int i = -120; i < 120; ++i) {
            float p = std::ldexp(1.0f, i);
            boxes.push_back({{p, p, p}, {p * 1.01f, p * 1.01f, p * 1.01f}});
        }
    check_tree(build_sah(boxes), boxes, boxes.size());
}

TEST(Sah, HugeAndTinyNumbersDoNotUpsetIt) {
    std::vector<Bounds3> boxes;
    Rng rng(3);
    for (int i = 0; i < 2000; ++i) {
        Vec3 p = random_point(rng, 1) * (i % 2 ? 3.3e38f : 1e-42f);
        boxes.push_back({p, p});
    }
    boxes.push_back({{-3.4e38f, -3.4e38f, -3.4e38f}, {3.4e38f, 3.4e38f, 3.4e38f}});
    check_tree(build_sah(boxes), boxes, boxes.size());
}

TEST(Sah, OptionsMayAskForNoMoreThanTheTreeAllows) {
    auto boxes = random_triangles(1000, 1, 1, 4).boxes();
    check_tree(build_sah(boxes, {.node_cost = 1000, .leaf_size = 1000}), boxes, boxes.size());
    check_tree(build_sah(boxes, {.node_cost = 0, .leaf_size = 1}), boxes, boxes.size());
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
    Triangles t = random_triangles(2000, 1, 0.1f, 8);
    Tree tree = build_sah(t.boxes());
    for (Corners& c : t.list)
        for (Vec3* p : {&c.a, &c.b, &c.c}) *p = Vec3{p->y, p->x * 2, p->z + 1};
    refit(tree, t.boxes());
    check_tree(tree, t.boxes(), 2000);
    for (const AccelWalk& walk : accel_walks()) {
        auto structure = walk.make(t, tree, {});
        NoTests tests;
        Rng rng(9);
        for (int i = 0; i < 500; ++i) {
            Ray ray = random_ray(t, 1, rng);
            Intersection hit, expected = t.brute_force(ray);
            structure->closest(ray, hit, tests);
            ASSERT_EQ(hit.primitive, expected.primitive) << walk.name;
            ASSERT_EQ(hit.t, expected.t) << walk.name;
        }
    }
}

} // namespace
} // namespace alhazen
