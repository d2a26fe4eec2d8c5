#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "accel/build/linked_tree.h"
#include "accel/build/reinsertion.h"
#include "base/threads.h"
#include "tests/unit/accel/awkward_boxes.h"
#include "tests/unit/accel/check_tree.h"

namespace alhazen {
namespace {

using namespace accel_test;

// Halves the primitives as they are numbered, wherever they are; leaves of leaf_size.
Tree build_blindly(const std::vector<Bounds3>& boxes, std::uint32_t leaf_size) {
    LinkedTree tree;
    tree.nodes = BigArray<LinkedTree::Node>(2 * boxes.size());
    std::uint32_t used = 0;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) tree.order.push_back(i);
    auto halve = [&](auto&& self, std::uint32_t begin, std::uint32_t end) -> std::uint32_t {
        if (end - begin <= leaf_size) {
            Bounds3 box;
            for (std::uint32_t i = begin; i < end; ++i) box.extend(boxes[i]);
            tree.nodes[used].make_leaf(box, begin, end - begin);
        } else {
            std::uint32_t middle = begin + (end - begin) / 2;
            std::uint32_t left = self(self, begin, middle), right = self(self, middle, end);
            tree.nodes[used].make_inner(left, right);
        }
        return used++;
    };
    tree.root = halve(halve, 0, static_cast<std::uint32_t>(boxes.size()));
    return finish(std::move(tree), {.leaf_size = 1});
}

// One box after the other is split off, from the last; depth edges.
Tree build_comb(const std::vector<Bounds3>& boxes) {
    LinkedTree tree;
    tree.nodes = BigArray<LinkedTree::Node>(2 * boxes.size() - 1);
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        tree.nodes[i].make_leaf(boxes[i], i, 1);
        tree.order.push_back(i);
    }
    auto used = static_cast<std::uint32_t>(boxes.size());
    for (std::uint32_t i = 1; i < boxes.size(); ++i, ++used)
        tree.nodes[used].make_inner(i, i == 1 ? 0 : used - 1);
    tree.root = used - 1;
    return finish(std::move(tree), {.leaf_size = 1});
}

using Leaves = std::vector<std::vector<std::uint32_t>>;

Leaves leaves_of(const Tree& tree) {
    Leaves leaves;
    for (const Tree::Node& n : tree.nodes)
        if (n.is_leaf())
            leaves.emplace_back(tree.order.begin() + n.first_or_right,
                                tree.order.begin() + n.first_or_right + n.count);
    std::sort(leaves.begin(), leaves.end());
    return leaves;
}

// Returns cost after / cost before.
double expect_no_worse(Tree tree, const std::vector<Bounds3>& boxes) {
    Leaves leaves = leaves_of(tree);
    double before = stats_of(tree).sah_cost;
    optimize_by_reinsertion(tree);
    check_tree_of_boxes(tree, boxes);
    EXPECT_TRUE(leaves_of(tree) == leaves);
    double after = stats_of(tree).sah_cost;
    if (std::isfinite(before)) {
        // But for the rounding of sums in another order.
        EXPECT_LE(after, before * (1 + 1e-12));
    }
    return before > 0 ? after / before : 1;
}

TEST(Reinsertion, RepairsABadTree) {
    auto boxes = random_triangles(3000, 1, 0.02f, 1).boxes();
    double sah = stats_of(sah_builder().build(Triangles{}, boxes, {.leaf_size = 1})).sah_cost;
    Tree tree = build_blindly(boxes, 1);
    double before = stats_of(tree).sah_cost;
    optimize_by_reinsertion(tree, {.rounds = 40});
    check_tree_of_boxes(tree, boxes);
    double after = stats_of(tree).sah_cost;
    RecordProperty("before_over_sah", std::to_string(before / sah));
    RecordProperty("after_over_sah", std::to_string(after / sah));
    EXPECT_LT(after, before / 20);
    EXPECT_LT(after, 1.5 * sah);
}

TEST(Reinsertion, NeverRaisesTheCostOfAnyBuildersTree) {
    std::vector<NamedBoxes> inputs = awkward_boxes();
    inputs.push_back({"soup", random_triangles(5000, 1, 0.02f, 2).boxes()});
    inputs.push_back({"mixed", mixed_boxes(5000, 3)});
    inputs.push_back({"overlapping", random_triangles(2000, 1, 1, 4).boxes()});
    for (const NamedBoxes& input : inputs)
        for (const AccelBuilder& builder : {sah_builder(), ploc_builder()})
            for (std::uint32_t leaf_size : {1u, 4u}) {
                SCOPED_TRACE(input.name + " " + std::string(builder.name));
                expect_no_worse(builder.build(Triangles{}, input.boxes, {.leaf_size = leaf_size}),
                                input.boxes);
            }
}

TEST(Reinsertion, LeavesOfSeveralStayWhole) {
    auto boxes = random_triangles(3000, 1, 0.02f, 5).boxes();
    EXPECT_LT(expect_no_worse(build_blindly(boxes, 5), boxes), 0.9);
    for (const NamedBoxes& input : awkward_boxes()) {
        if (std::any_of(input.boxes.begin(), input.boxes.end(), [](const Bounds3& b) { return b.empty(); }))
            continue;
        SCOPED_TRACE(input.name);
        if (!input.boxes.empty()) expect_no_worse(build_blindly(input.boxes, 3), input.boxes);
    }
}

TEST(Reinsertion, PathsStayBounded) {
    // As deep as a tree may be, and ever larger boxes, which are cheapest when they stand like this.
    std::vector<Bounds3> boxes;
    for (int i = 0; i <= Tree::max_depth; ++i) {
        float r = std::ldexp(1.0f, i - 60);
        boxes.push_back({{0, 0, 0}, {r, r, r}});
    }
    expect_no_worse(build_comb(boxes), boxes);
    expect_no_worse(build_blindly(boxes, 1), boxes);
    // With more boxes than fit such a tree, the limit is what stops it.
    for (int copy = 0; copy < 4; ++copy)
        for (int i = -60; i < 60; ++i) {
            float r = std::ldexp(1.0f + 0.2f * static_cast<float>(copy), i);
            boxes.push_back({{0, 0, 0}, {r, r, r}});
        }
    EXPECT_LT(expect_no_worse(build_blindly(boxes, 1), boxes), 1);
}

TEST(Reinsertion, FindsTheBestTreeOfFour) {
    // Two pairs, joined wrongly.
    std::vector<Bounds3> boxes{
        {{0, 0, 0}, {1, 1, 1}}, {{50, 0, 0}, {51, 1, 1}}, {{1, 0, 0}, {2, 1, 1}}, {{51, 0, 0}, {52, 1, 1}}};
    Tree tree = build_blindly(boxes, 1);
    optimize_by_reinsertion(tree);
    // Inner nodes: the root of 52 x 1 x 1, two of 2 x 1 x 1; leaves: four of 1 x 1 x 1.
    EXPECT_NEAR(stats_of(tree).sah_cost, (105.0 + 2 * 5 + 4 * 3) / 105, 1e-3);
}

TEST(Reinsertion, TheNumberOfThreadsDoesNotChangeABit) {
    auto boxes = mixed_boxes(5000, 6);
    const Tree start = build_blindly(boxes, 1);
    expect_same_on_any_threads([&] {
        Tree tree = start;
        optimize_by_reinsertion(tree);
        return tree;
    });
}

TEST(Reinsertion, IsChosenByAPlusBehindTheBuilder) {
    std::string error;
    auto choice = parse_accel("ploc+reinsertion/stack", error);
    ASSERT_TRUE(choice);
    EXPECT_EQ(choice->builder, "ploc+reinsertion");
    EXPECT_EQ(choice->name(), "ploc+reinsertion/stack");
    EXPECT_EQ(parse_accel("+reinsertion", error)->name(), "sah+reinsertion/wide");
    EXPECT_EQ(parse_accel("/stack", error)->name(), "sah/stack");

    EXPECT_FALSE(parse_accel("plok+reinsertion", error));
    EXPECT_EQ(error.find("unknown builder \"plok\""), 0u) << error;
    EXPECT_FALSE(parse_accel("ploc+reinsertoin", error));
    EXPECT_EQ(error.find("unknown optimiser \"reinsertoin\""), 0u) << error;
    EXPECT_NE(error.find("reinsertion"), std::string::npos) << error;
    EXPECT_FALSE(parse_accel("ploc+", error));
    EXPECT_FALSE(parse_accel("ploc+reinsertion+reinsertion", error));

    Triangles t = random_triangles(3000, 1, 0.05f, 7);
    Tree plain = build_tree(t, *parse_accel("ploc/stack", error));
    Tree improved = build_tree(t, *parse_accel("ploc+reinsertion/stack", error));
    EXPECT_LT(stats_of(improved).sah_cost, stats_of(plain).sah_cost);
}

} // namespace
} // namespace alhazen
