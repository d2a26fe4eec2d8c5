#include <gtest/gtest.h>

#include <cstring>

#include "accel/build/linked_tree.h"
#include "accel/build/morton.h"
#include "base/threads.h"
#include "tests/unit/accel/awkward_boxes.h"
#include "tests/unit/accel/check_tree.h"

namespace alhazen {
namespace {

using namespace accel_test;

Tree build_ploc(const std::vector<Bounds3>& boxes, const BuildOptions& options = {}) {
    return ploc_builder().build(Triangles{}, boxes, options);
}

// The tree that halves each run of the primitives in Morton order.
Tree build_halving(const std::vector<Bounds3>& boxes, const BuildOptions& options = {}) {
    auto keys = morton_keys(boxes);
    sort_by_code(keys);
    LinkedTree tree;
    tree.nodes = BigArray<LinkedTree::Node>(2 * keys.size() - 1);
    std::uint32_t used = 0;
    for (const MortonKey& key : keys) {
        auto place = static_cast<std::uint32_t>(tree.order.size());
        tree.nodes[used++].make_leaf(boxes[key.index], place, 1);
        tree.order.push_back(key.index);
    }
    auto halve = [&](auto&& self, std::uint32_t begin, std::uint32_t end) -> std::uint32_t {
        if (end - begin == 1) return begin;
        std::uint32_t middle = begin + (end - begin) / 2;
        std::uint32_t left = self(self, begin, middle), right = self(self, middle, end);
        tree.nodes[used].make_inner(left, right);
        return used++;
    };
    tree.root = halve(halve, 0, static_cast<std::uint32_t>(keys.size()));
    return finish(std::move(tree), options);
}

std::vector<Bounds3> terrain(int size) {
    std::vector<Corners> list;
    auto at = [](int i, int j) {
        auto x = static_cast<float>(i), z = static_cast<float>(j);
        return Vec3{x, 8 * std::sin(0.11f * x) * std::cos(0.07f * z) + std::sin(x * z), z};
    };
    for (int j = 0; j < size; ++j)
        for (int i = 0; i < size; ++i) {
            list.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            list.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return Triangles(list).boxes();
}

TEST(Ploc, BuildsProperTrees) {
    for (std::size_t n : {9u, 33u, 1000u, 50000u}) {
        auto boxes = random_triangles(n, 1, 0.01f, n).boxes();
        check_tree_of_boxes(build_ploc(boxes), boxes);
    }
    auto boxes = random_triangles(1000, 1, 1, 4).boxes();
    check_tree_of_boxes(build_ploc(boxes, {.node_cost = 1000, .leaf_size = 1000}), boxes);
    EXPECT_EQ(build_ploc(boxes, {.node_cost = 1000, .leaf_size = 1}).nodes.size(), 1999u);
}

TEST(Ploc, AwkwardInputsGiveProperTrees) {
    for (const NamedBoxes& input : awkward_boxes()) {
        SCOPED_TRACE(input.name);
        check_tree_of_boxes(build_ploc(input.boxes), input.boxes);
    }
    // Coincident boxes pair off: each round halves them.
    std::vector<Bounds3> boxes(10000, Bounds3{{1, 2, 3}, {4, 5, 6}});
    EXPECT_LE(check_tree_of_boxes(build_ploc(boxes, {.leaf_size = 1}), boxes), 14);
}

TEST(Ploc, NestedBoxesDoNotTakeOneRoundEach) {
    // Everybody prefers those inside, so only the innermost two choose each other.
    std::vector<Bounds3> boxes;
    for (int i = 0; i < 100000; ++i) {
        auto r = static_cast<float>(i);
        boxes.push_back({{-r, -r, -r}, {r, r, r}});
    }
    EXPECT_LE(check_tree_of_boxes(build_ploc(boxes), boxes), Tree::max_depth);
}

TEST(Ploc, TwoClustersAreSeparatedAtTheRoot) {
    // Nearest pairs are found within the clusters first, whatever the order of the input.
    std::vector<Bounds3> boxes;
    Rng rng(5);
    for (int i = 0; i < 1000; ++i) {
        Vec3 p = random_point(rng, 1) + Vec3{i % 2 ? 100.0f : 0.0f, 0, 0};
        boxes.push_back({p, p});
    }
    Tree tree = build_ploc(boxes);
    const Bounds3 &left = tree.nodes[1].bounds, &right = tree.nodes[tree.nodes[0].first_or_right].bounds;
    EXPECT_LT(left.hi.x, 2);
    EXPECT_GT(right.lo.x, 98);
}

TEST(Ploc, CostsLessThanHalvingAndLittleMoreThanSah) {
    struct Input {
        const char* name;
        std::vector<Bounds3> boxes;
        double most_over_sah;
    };
    const Input inputs[] = {
        {"soup", random_triangles(40000, 1, 0.02f, 6).boxes(), 1.2},
        {"mixed sizes", mixed_boxes(40000, 7), 1.2},
        {"terrain", terrain(128), 1.25},
    };
    for (const Input& input : inputs) {
        double ploc = stats_of(build_ploc(input.boxes)).sah_cost;
        double halving = stats_of(build_halving(input.boxes)).sah_cost;
        double sah = stats_of(sah_builder().build(Triangles{}, input.boxes, {})).sah_cost;
        RecordProperty(input.name, std::to_string(ploc / sah));
        EXPECT_LT(ploc, halving) << input.name;
        EXPECT_LT(ploc, input.most_over_sah * sah) << input.name;
    }
}

TEST(Ploc, TheScenesSizeDoesNotMatter) {
    // Where areas overflow and where they vanish, the same tree is built.
    auto boxes = mixed_boxes(3000, 8);
    Tree tree = build_ploc(boxes, {.leaf_size = 1});
    for (float scale : {0x1p-100f, 0x1p100f}) {
        auto other = boxes;
        for (Bounds3& b : other) b = {b.lo * scale, b.hi * scale};
        EXPECT_EQ(build_ploc(other, {.leaf_size = 1}).order, tree.order) << scale;
    }
}

TEST(Ploc, TheNumberOfThreadsDoesNotChangeABit) {
    auto boxes = mixed_boxes(120000, 9);
    expect_same_on_any_threads([&] { return build_ploc(boxes); });
}

TEST(LinkedTree, FinishingKeepsATreeOrMakesItCheaper) {
    auto boxes = mixed_boxes(5000, 10);
    const Tree singles = build_ploc(boxes, {.leaf_size = 1});
    Tree same = singles;
    collapse_leaves(same, {.leaf_size = 1});
    ASSERT_EQ(same.nodes.size(), singles.nodes.size());
    EXPECT_EQ(std::memcmp(same.nodes.data(), singles.nodes.data(), same.nodes.size() * sizeof(Tree::Node)),
              0);
    EXPECT_EQ(same.order, singles.order);
    for (std::uint32_t block : {1u, 4u})
        for (float node_cost : {0.1f, 1.0f, 3.0f}) {
            Tree tree = singles;
            collapse_leaves(tree, {.node_cost = node_cost, .leaf_size = 8, .block = block});
            check_tree_of_boxes(tree, boxes);
            EXPECT_EQ(tree.order, singles.order);
            EXPECT_LE(stats_of(tree, node_cost, block).sah_cost,
                      stats_of(singles, node_cost, block).sah_cost);
        }
}

TEST(LinkedTree, LeavesAreMadeWhereTheyAreCheaper) {
    // Two boxes far apart: testing both costs 2, a node and one box at most 1 + (little). Close together: the
    // node's boxes are both almost always met, and a node more costs more than it saves.
    std::vector<Bounds3> apart{{{0, 0, 0}, {1, 1, 1}}, {{99, 0, 0}, {100, 1, 1}}};
    std::vector<Bounds3> close{{{0, 0, 0}, {1, 1, 1}}, {{0.1f, 0, 0}, {1, 1, 1}}};
    EXPECT_EQ(build_ploc(apart).nodes.size(), 3u);
    EXPECT_EQ(build_ploc(close).nodes.size(), 1u);
    EXPECT_EQ(build_ploc(close, {.node_cost = 0.01f}).nodes.size(), 3u);
    EXPECT_EQ(build_ploc(apart, {.block = 2}).nodes.size(), 1u);
}

} // namespace
} // namespace alhazen
