/// Nodes found by their paths.

#include "accel/layout/hashed.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/unit/accel/support.h"

namespace alhazen {
namespace {

using namespace accel_test;

TEST(PathHash, EveryKeyFindsItsNodeAndNoTwoMeet) {
    for (std::size_t n : {1u, 2u, 3u, 10u, 1000u, 20000u}) {
        Triangles t = random_triangles(n, 1, 0.1f, n);
        HashedLayout layout(sah_builder().build(t, t.boxes(), {1, 1}));
        auto paths = paths_of(layout.binary);
        ASSERT_EQ(paths.size(), 2 * (n - 1));
        std::set<std::size_t> places;
        for (const PathHash::Entry& e : paths) {
            const BinaryChild& found = layout.by_path.find(e.key);
            ASSERT_EQ(found.index, e.node.index);
            ASSERT_EQ(found.count, e.node.count);
            places.insert(layout.by_path.place(e.key));
        }
        EXPECT_EQ(places.size(), paths.size());
        EXPECT_LE(layout.by_path.size(), std::max<std::size_t>(1, 3 * paths.size()));
    }
}

TEST(PathHash, KeysSpellThePathFromTheRoot) {
    Triangles t = random_triangles(100, 1, 0.1f, 1);
    HashedLayout layout(sah_builder().build(t, t.boxes(), {1, 2}));
    for (const PathHash::Entry& e : paths_of(layout.binary)) {
        int levels = 0;
        while (e.key >> (levels + 1) != 0) ++levels;
        BinaryChild node = layout.binary.root;
        while (levels-- > 0) {
            ASSERT_EQ(node.count, 0u);
            node = layout.binary.nodes[node.index].child(static_cast<int>(e.key >> levels & 1));
        }
        EXPECT_EQ(node.index, e.node.index);
        EXPECT_EQ(node.count, e.node.count);
    }
}

// A tree as deep as trees may be: each inner node has a leaf on its left.
TEST(PathHash, KeysOfTheDeepestTreesAreKeptApart) {
    Triangles t = random_triangles(1, 1, 1, 2);
    t.list.resize(Tree::max_depth + 1, t.list[0]);
    auto boxes = t.boxes();
    Tree tree;
    for (std::uint32_t i = 0; i < Tree::max_depth; ++i) {
        tree.nodes.push_back({boxes[0], 2 * i + 2, 0});
        tree.nodes.push_back({boxes[0], i, 1});
        tree.order.push_back(Tree::max_depth - i);
    }
    tree.nodes.push_back({boxes[0], Tree::max_depth, 1});
    tree.order.push_back(0);
    ASSERT_EQ(stats_of(tree).depth, Tree::max_depth);

    auto structure = stackless_walk().make(t, tree, {});
    TriangleTests tests(t);
    Ray ray{{0, 0, 10}, (t.list[0].a + t.list[0].b + t.list[0].c) * (1 / 3.0f) - Vec3{0, 0, 10}};
    Intersection hit;
    WalkCounts counts;
    EXPECT_TRUE(structure->closest(ray, hit, tests));
    EXPECT_EQ(hit.primitive, 0u); // the deepest leaf's, of equal hits
    structure->count(Query::closest, ray, tests, counts);
    EXPECT_EQ(counts.leaves, Tree::max_depth + 1u);
    EXPECT_EQ(counts.nodes, static_cast<std::uint64_t>(Tree::max_depth));
}

TEST(Stackless, HasNoStackAndVisitsWhatAStackWouldOrALittleMore) {
    Triangles t = random_triangles(5000, 1, 0.03f, 3);
    Tree tree = sah_builder().build(t, t.boxes(), {});
    auto stackless = stackless_walk().make(t, tree, {}), stack = stack_walk().make(t, tree, {});
    TriangleTests tests(t);
    Rng rng(4);
    WalkCounts a, b, a_any, b_any;
    for (int i = 0; i < 500; ++i) {
        Ray ray = random_ray(t, 1, rng);
        stackless->count(Query::closest, ray, tests, a);
        stack->count(Query::closest, ray, tests, b);
        stackless->count(Query::any, ray, tests, a_any);
        stack->count(Query::any, ray, tests, b_any);
    }
    EXPECT_EQ(a.max_stack, 0u);
    EXPECT_EQ(a.restarts, 0u);
    EXPECT_GT(b.max_stack, 0u);
    EXPECT_GE(a.nodes, b.nodes);
    EXPECT_LE(a.nodes, b.nodes * 3 / 2);
    // Until something is hit there is nothing for a stack to leave out.
    EXPECT_EQ(a_any.nodes, b_any.nodes);
    EXPECT_EQ(a_any.leaves, b_any.leaves);
}

} // namespace
} // namespace alhazen
