#include "accel/build/lbvh.h"

#include "accel/build/leaf_runs.h"
#include "accel/build/radix_tree.h"
#include "tests/unit/accel/check_tree.h"
#include "tests/unit/accel/support.h"

namespace alhazen {
namespace {

using namespace accel_test;

std::vector<MortonKey> keys_of(const std::vector<std::uint64_t>& codes) {
    std::vector<MortonKey> keys;
    for (std::uint64_t code : codes) keys.push_back({code, static_cast<std::uint32_t>(keys.size())});
    sort_by_code(keys);
    return keys;
}

// A key is a code and, behind it, its place in the order.
bool bit_of(const std::vector<MortonKey>& keys, std::uint32_t leaf, int bit) {
    return bit < 64 ? keys[leaf].code >> (63 - bit) & 1 : leaf >> (95 - bit) & 1;
}

// Compares the subtree over first ... last with the one found by looking for the first bit that differs.
void check_radix(const RadixTree& tree, const std::vector<MortonKey>& keys, std::uint32_t number,
                 std::uint32_t first, std::uint32_t last, std::uint32_t parent) {
    if (first == last) {
        ASSERT_EQ(tree.parent_of_leaf(first), parent);
        return;
    }
    int bit = 0;
    while (bit_of(keys, first, bit) == bit_of(keys, last, bit)) ++bit;
    std::uint32_t split = first;
    while (!bit_of(keys, split + 1, bit)) ++split;
    RadixTree::Node n = tree.node(number);
    ASSERT_EQ(n.first, first);
    ASSERT_EQ(n.last, last);
    ASSERT_EQ(n.split, split);
    ASSERT_EQ(tree.common_bits(number), std::min(bit, 64));
    ASSERT_EQ(tree.parent_of_inner(number), parent);
    check_radix(tree, keys, split, first, split, number);
    check_radix(tree, keys, split + 1, split + 1, last, number);
}

TEST(RadixTree, BranchesAtTheFirstBitThatDiffers) {
    // The example of the paper's figure 3.
    std::vector<std::vector<std::uint64_t>> cases{{1, 2, 4, 5, 19, 24, 25, 30}, {7, 7}, {0, ~0ull >> 1}};
    cases.push_back(std::vector<std::uint64_t>(1000, 5));
    Rng rng(1);
    for (int shift : {0, 12, 28, 31}) {
        cases.emplace_back();
        for (int i = 0; i < 20000; ++i)
            cases.back().push_back((static_cast<std::uint64_t>(rng.next()) << 31 | rng.next()) >> shift);
        for (int i = 0; i < 20000; ++i) cases.back().push_back(rng.next() >> shift);
    }
    for (const auto& codes : cases) {
        auto keys = keys_of(codes);
        RadixTree tree(keys);
        auto last = static_cast<std::uint32_t>(keys.size() - 1);
        check_radix(tree, keys, 0, 0, last, RadixTree::none);
        if (HasFatalFailure()) return;
    }
}

TEST(RadixTree, NodesAreVisitedAfterTheirChildren) {
    auto boxes = random_triangles(50000, 1, 0.01f, 2).boxes();
    auto keys = morton_keys(boxes);
    sort_by_code(keys);
    RadixTree tree(keys);
    std::vector<std::uint32_t> sum(tree.inner(), 0);
    std::atomic<std::size_t> visited = 0;
    tree.bottom_up([&](std::uint32_t i, RadixTree::Node n) {
        sum[i] = (n.split == n.first ? 1 : sum[n.split]) + (n.split + 1 == n.last ? 1 : sum[n.split + 1]);
        EXPECT_EQ(sum[i], n.count());
        ++visited;
    });
    EXPECT_EQ(visited, tree.inner());
}

// The runs as the radix tree has them.
void collect_runs(const RadixTree& tree, std::uint32_t first, std::uint32_t last, std::uint32_t number,
                  std::uint32_t size, std::vector<std::uint32_t>& firsts) {
    if (last - first + 1 <= size) {
        firsts.push_back(first);
        return;
    }
    const RadixTree::Node n = tree.node(number);
    collect_runs(tree, n.first, n.split, n.split, size, firsts);
    collect_runs(tree, n.split + 1, n.last, n.split + 1, size, firsts);
}

TEST(LeafRuns, AreTheLargestSubtreesOfSoManyKeys) {
    for (std::size_t n : {1u, 2u, 8u, 9u, 100u, 20000u})
        for (int bits : {2, 5, 21})
            for (std::uint32_t size : {1u, 2u, 3u, 8u, 16u}) {
                auto keys = morton_keys(random_triangles(n, 1, 0.01f, n).boxes(), bits);
                sort_by_code(keys);
                std::vector<std::uint32_t> expected;
                RadixTree tree(keys);
                collect_runs(tree, 0, static_cast<std::uint32_t>(n - 1), 0, size, expected);
                LeafRuns runs(keys, size);
                ASSERT_EQ(runs.count(), expected.size()) << n << " keys of " << bits << " bits";
                for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_EQ(runs.first(i), expected[i]);
                EXPECT_EQ(runs.first(runs.count()), n);
            }
}

TEST(Lbvh, ALayoutThatJoinsPrimitivesGetsThemJoined) {
    Triangles t = random_triangles(5000, 1, 0.01f, 7);
    auto boxes = t.boxes();
    Tree joined = lbvh_builder().build(t, boxes, {.leaf_size = 1, .joined = 8});
    Tree expected = build_lbvh(boxes, {.leaf_size = 8, .block = 8});
    check_tree_of_boxes(joined, boxes);
    ASSERT_EQ(joined.nodes.size(), expected.nodes.size());
    EXPECT_EQ(joined.order, expected.order);
    EXPECT_GT(5000.0 / static_cast<double>(stats_of(joined).leaves), 4);
    EXPECT_EQ(stats_of(build_lbvh(boxes, {.leaf_size = 1})).leaves, 5000u);
}

TEST(BuildTree, OnlyTrianglesAreJoined) {
    Triangles t = random_triangles(1000, 1, 0.01f, 8);
    for (const char* builder : {"lbvh", "sah", "lbvh+reinsertion"}) {
        const AccelChoice choice{builder, "wide", {}};
        t.kinds.clear();
        const std::size_t joined = stats_of(build_tree(t, choice)).leaves;
        t.kinds.assign(t.list.size(), PrimitiveKind::custom);
        const std::size_t single = stats_of(build_tree(t, choice)).leaves;
        EXPECT_EQ(single, 1000u) << builder;
        EXPECT_EQ(joined < single, std::string(builder) != "lbvh+reinsertion") << builder;
    }
}

TEST(Lbvh, BuildsAProperTree) {
    for (MortonBits bits : {MortonBits::bits_30, MortonBits::bits_63})
        for (std::size_t n : {0u, 1u, 2u, 3u, 5u, 9u, 1000u, 50000u}) {
            auto boxes = random_triangles(n, 1, 0.01f, n).boxes();
            for (std::size_t i = 4; i < n; i += 9) boxes[i] = {};
            check_tree_of_boxes(build_lbvh(boxes, {}, bits), boxes);
        }
    EXPECT_TRUE(build_lbvh(std::vector<Bounds3>(5), {}).nodes.empty());
}

TEST(Lbvh, CoincidentBoxesAreHalved) {
    std::vector<Bounds3> boxes(10000, Bounds3{{1, 2, 3}, {4, 5, 6}});
    EXPECT_LE(check_tree_of_boxes(build_lbvh(boxes, {}), boxes), 14);
}

TEST(Lbvh, DepthStaysBoundedForGeometricSequences) {
    std::vector<Bounds3> boxes;
    for (int copy = 0; copy < 20; ++copy)
        for (int i = -120; i < 120; ++i) {
            float p = std::ldexp(1.0f, i);
            boxes.push_back({{p, p, p}, {p * 1.01f, p * 1.01f, p * 1.01f}});
        }
    check_tree_of_boxes(build_lbvh(boxes, {.leaf_size = 1}), boxes);
}

TEST(Lbvh, HugeAndTinyNumbersDoNotUpsetIt) {
    std::vector<Bounds3> boxes;
    Rng rng(3);
    for (int i = 0; i < 2000; ++i) {
        Vec3 p = random_point(rng, 1) * (i % 2 ? 3.3e38f : 1e-42f);
        boxes.push_back({p, p});
    }
    boxes.push_back({{-3.4e38f, -3.4e38f, -3.4e38f}, {3.4e38f, 3.4e38f, 3.4e38f}});
    for (MortonBits bits : {MortonBits::bits_30, MortonBits::bits_63})
        check_tree_of_boxes(build_lbvh(boxes, {}, bits), boxes);
}

TEST(Lbvh, OptionsMayAskForNoMoreThanTheTreeAllows) {
    auto boxes = random_triangles(1000, 1, 1, 4).boxes();
    Tree tree = build_lbvh(boxes, {.node_cost = 1000, .leaf_size = 1000});
    check_tree_of_boxes(tree, boxes);
    EXPECT_LT(stats_of(tree).leaves, 500u);
    tree = build_lbvh(boxes, {.node_cost = 0, .leaf_size = 1});
    check_tree_of_boxes(tree, boxes);
    EXPECT_EQ(stats_of(tree).leaves, 1000u);
}

TEST(Lbvh, LeavesAreWhatTheHeuristicSays) {
    // Four boxes on a line, two and two close together. With a node worth half a test, a pair's own box must
    // be split unless its children overlap a lot.
    auto box = [](float x, float size) { return Bounds3{{x, 0, 0}, {x + size, 1, 1}}; };
    std::vector<Bounds3> boxes{box(0, 1), box(0.1f, 1), box(6, 1), box(7, 1)};
    Tree tree = build_lbvh(boxes, {.node_cost = 0.5f, .leaf_size = 4});
    TreeStats stats = stats_of(tree);
    EXPECT_EQ(stats.leaves, 3u); // the overlapping pair is one leaf
    EXPECT_EQ(tree.nodes[1].count, 2u);
    EXPECT_EQ(stats_of(build_lbvh(boxes, {.node_cost = 100, .leaf_size = 4})).leaves, 1u);
    EXPECT_EQ(stats_of(build_lbvh(boxes, {.node_cost = 100, .leaf_size = 3})).leaves, 2u);
}

TEST(Lbvh, MoreBitsTellMoreApart) {
    // A cluster that is smaller than a 1024th of the scene: 30 bits give all of it one code, so that the
    // order of the numbers decides, 63 bits sort it.
    Triangles t = random_triangles(2000, 1e-4f, 1e-6f, 6);
    t.add(random_triangles(10, 1, 0.1f, 7));
    auto boxes = t.boxes();
    double coarse = stats_of(build_lbvh(boxes, {}, MortonBits::bits_30)).sah_cost;
    double fine = stats_of(build_lbvh(boxes, {}, MortonBits::bits_63)).sah_cost;
    EXPECT_LT(fine, coarse);
}

TEST(Lbvh, IsNotMuchWorseThanTheHeuristic) {
    auto boxes = random_triangles(20000, 1, 0.02f, 8).boxes();
    double sah = stats_of(sah_builder().build(Triangles{}, boxes, {})).sah_cost;
    double lbvh = stats_of(build_lbvh(boxes, {})).sah_cost;
    EXPECT_LT(lbvh, 1.5 * sah);
}

TEST(Lbvh, TheNumberOfThreadsDoesNotChangeABit) {
    auto boxes = random_triangles(120000, 1, 0.01f, 5).boxes();
    for (std::size_t i = 0; i < boxes.size(); i += 7) boxes[i] = boxes[i / 2]; // some coincide
    for (std::size_t i = 3; i < boxes.size(); i += 11) boxes[i].lo.x = -0.0f, boxes[i].hi.x = 0.0f;
    expect_same_on_any_threads([&] { return build_lbvh(boxes, {}); });
}

} // namespace
} // namespace alhazen
