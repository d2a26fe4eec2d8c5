/// The collapse of binary trees into wide ones: nothing lost, nothing too large, and no choice cheaper.

#include "accel/layout/wide_tree.h"

#include <gtest/gtest.h>

#include <map>

#include "tests/unit/accel/support.h"

namespace alhazen {
namespace {

using namespace accel_test;

Tree tree_of(const Triangles& t, const BuildOptions& options) {
    return sah_builder().build(t, t.boxes(), options);
}

double area(const Bounds3& b) {
    return static_cast<double>(b.half_area());
}

double cost_of(const WideTree& wide, const Bounds3& root, const CollapseCost& cost) {
    double sum = static_cast<double>(cost.node) * area(root);
    for (const WideTree::Child& c : wide.children)
        sum += area(c.bounds) *
               static_cast<double>(c.is_leaf() ? static_cast<float>(c.count) * cost.primitive : cost.node);
    return sum;
}

bool contains(const Bounds3& outer, const Bounds3& inner) {
    return outer.contains(inner.lo) && outer.contains(inner.hi);
}

TEST(WideTree, HoldsEveryPlaceOnceInsideItsBoxes) {
    Triangles t = random_triangles(500, 1, 0.1f, 1);
    auto boxes = t.boxes();
    for (std::uint32_t leaf_size : {1u, 4u, 8u})
        for (int width : {2, 3, 4, 8})
            for (std::uint32_t max_leaf : {1u, 3u, 8u}) {
                Tree tree = tree_of(t, {1, leaf_size});
                WideTree wide = collapse(tree, width, max_leaf);
                std::vector<int> seen(tree.order.size(), 0);
                std::vector<int> parents(wide.nodes.size(), 0);
                std::vector<Bounds3> bounds(wide.nodes.size());
                bounds[0] = tree.nodes[0].bounds;
                for (std::size_t n = 0; n < wide.nodes.size(); ++n) {
                    auto children = wide.children_of(wide.nodes[n]);
                    ASSERT_GE(children.size(), 2u);
                    ASSERT_LE(children.size(), static_cast<std::size_t>(width));
                    std::uint32_t next = 0;
                    for (const WideTree::Child& c : children) {
                        EXPECT_TRUE(contains(bounds[n], c.bounds));
                        if (!c.is_leaf()) {
                            ASSERT_GT(c.index, n);
                            EXPECT_TRUE(next == 0 || c.index == next) << "nodes follow one another";
                            next = c.index + 1;
                            ++parents[c.index];
                            bounds[c.index] = c.bounds;
                        }
                        ASSERT_LE(c.count, max_leaf);
                        for (std::uint32_t k = 0; k < c.count; ++k) {
                            ++seen[c.index + k];
                            EXPECT_TRUE(contains(c.bounds, boxes[tree.order[c.index + k]]));
                        }
                    }
                }
                for (int count : seen) EXPECT_EQ(count, 1);
                for (std::size_t n = 1; n < parents.size(); ++n) EXPECT_EQ(parents[n], 1);
            }
}

// The least cost by trying every cut through the tree, without the dynamic programme's reuse of forests.
class Exhaustive {
  public:
    Exhaustive(const Tree& tree, std::size_t width, std::uint32_t max_leaf, const CollapseCost& cost)
        : tree_(tree), width_(width), max_leaf_(max_leaf), cost_(cost) {}

    double node(std::size_t i) {
        auto known = nodes_.find(i);
        if (known != nodes_.end()) return known->second;
        double least = 1e30;
        const Tree::Node& n = tree_.nodes[i];
        if (count(i) <= max_leaf_)
            least = area(n.bounds) * static_cast<double>(static_cast<float>(count(i)) * cost_.primitive);
        if (!n.is_leaf()) least = std::min(least, inner(i));
        return nodes_[i] = least;
    }
    double inner(std::size_t i) {
        std::vector<std::size_t> roots{i + 1, tree_.nodes[i].first_or_right};
        return static_cast<double>(cost_.node) * area(tree_.nodes[i].bounds) + cut(roots, 0);
    }

  private:
    // roots before `from` stay; the others may be opened while there is room.
    double cut(std::vector<std::size_t>& roots, std::size_t from) {
        double least = 0;
        for (std::size_t r : roots) least += node(r);
        for (std::size_t k = from; k < roots.size() && roots.size() < width_; ++k) {
            const std::size_t opened = roots[k];
            if (tree_.nodes[opened].is_leaf()) continue;
            std::vector<std::size_t> more = roots;
            more[k] = opened + 1;
            more.insert(more.begin() + static_cast<std::ptrdiff_t>(k) + 1,
                        tree_.nodes[opened].first_or_right);
            least = std::min(least, cut(more, k));
        }
        return least;
    }
    std::uint32_t count(std::size_t i) const {
        const Tree::Node& n = tree_.nodes[i];
        return n.is_leaf() ? n.count : count(i + 1) + count(n.first_or_right);
    }

    const Tree& tree_;
    std::size_t width_;
    std::uint32_t max_leaf_;
    CollapseCost cost_;
    std::map<std::size_t, double> nodes_;
};

TEST(WideTree, CostsNoMoreThanAnyOtherCut) {
    for (std::uint64_t seed = 0; seed < 10; ++seed)
        for (int width : {4, 8})
            for (float primitive : {0.3f, 2.0f}) {
                Triangles t = random_triangles(12 + 4 * seed, 1, 0.5f, 30 + seed);
                Tree tree = tree_of(t, {1, 1});
                CollapseCost cost{1, primitive};
                WideTree wide = collapse(tree, width, 3, cost);
                double least = Exhaustive(tree, static_cast<std::size_t>(width), 3, cost).inner(0);
                EXPECT_NEAR(cost_of(wide, tree.nodes[0].bounds, cost), least, 1e-5 * least);
            }
}

TEST(WideTree, DearNodesMakeLeavesAndCheapNodesSplitThem) {
    Tree tree = tree_of(random_triangles(200, 1, 0.1f, 2), {1, 1});
    auto leaves = [&](CollapseCost cost) {
        std::size_t n = 0;
        for (const WideTree::Child& c : collapse(tree, 8, 3, cost).children) n += c.is_leaf();
        return n;
    };
    EXPECT_EQ(leaves({0, 1}), 200u);
    EXPECT_LT(leaves({10, 1}), 150u);
}

TEST(WideTree, OneLeafStandsBelowARoot) {
    Tree tree = tree_of(random_triangles(1, 1, 1, 3), {});
    WideTree wide = collapse(tree, 8, 3);
    ASSERT_EQ(wide.nodes.size(), 1u);
    ASSERT_EQ(wide.children.size(), 1u);
    EXPECT_EQ(wide.children[0].count, 1u);
    EXPECT_TRUE(collapse(Tree{}, 8, 3).nodes.empty());
}

TEST(WideTree, LeavesTooLargeAreSplitWhereTheyStand) {
    Tree tree;
    tree.nodes.push_back({{{0, 0, 0}, {1, 1, 1}}, 0, 8});
    for (std::uint32_t i = 0; i < 8; ++i) tree.order.push_back(i);
    WideTree wide = collapse(tree, 4, 1);
    std::vector<int> seen(8, 0);
    for (const WideTree::Child& c : wide.children) {
        EXPECT_EQ(c.bounds.hi.x, 1);
        ASSERT_LE(c.count, 1u);
        if (c.is_leaf()) ++seen[c.index];
    }
    for (int count : seen) EXPECT_EQ(count, 1);
    EXPECT_LE(wide.depth, 3);
}

TEST(WideTree, LeavesAreNotJoinedWhereTheirPlacesAreApart) {
    // Places 0 and 1 are a leaf on the right, 2 one on the left.
    Tree tree;
    tree.nodes = {
        {{{0, 0, 0}, {2, 1, 1}}, 2, 0}, {{{0, 0, 0}, {1, 1, 1}}, 2, 1}, {{{1, 0, 0}, {2, 1, 1}}, 0, 2}};
    tree.order = {0, 1, 2};
    WideTree wide = collapse(tree, 8, 8, {100, 1});
    EXPECT_EQ(wide.children.size(), 2u);
}

} // namespace
} // namespace alhazen
