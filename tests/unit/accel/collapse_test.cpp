/// The collapse of binary trees into wide ones: nothing lost, nothing too large, and no choice cheaper.

#include "accel/layout/collapse.h"

#include <gtest/gtest.h>

#include <map>

#include "base/threads.h"
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

float leaf_cost(std::uint32_t count, const CollapseCosts& costs) {
    return costs.leaf + static_cast<float>(count) * costs.triangle;
}

double cost_of(const CollapsedTree& wide, const Bounds3& root, const CollapseCosts& costs) {
    double sum = static_cast<double>(costs.node) * area(root);
    for (const CollapsedNode& node : wide.nodes.all())
        for (const WideChild& c : node.children())
            sum += area(c.bounds) *
                   static_cast<double>(c.is_leaf() ? leaf_cost(c.leaf.count, costs) : costs.node);
    return sum;
}

std::size_t leaves_of(const CollapsedTree& wide) {
    std::size_t n = 0;
    for (const CollapsedNode& node : wide.nodes.all())
        for (const WideChild& c : node.children()) n += c.is_leaf();
    return n;
}

bool contains(const Bounds3& outer, const Bounds3& inner) {
    return outer.contains(inner.lo) && outer.contains(inner.hi);
}

TEST(CollapsedTree, HoldsEveryPlaceOnceInsideItsBoxes) {
    Triangles t = random_triangles(500, 1, 0.1f, 1);
    auto boxes = t.boxes();
    for (std::uint32_t leaf_size : {1u, 4u, 8u})
        for (int width : {2, 3, 4, 8})
            for (std::uint32_t max_leaf : {1u, 3u, 8u}) {
                Tree tree = tree_of(t, {1, leaf_size});
                CollapsedTree wide =
                    collapse(tree, costs_by_primitive, {.width = width, .leaf_size = max_leaf});
                std::vector<int> seen(tree.order.size(), 0);
                std::vector<int> parents(wide.nodes.size(), 0);
                std::vector<Bounds3> bounds(wide.nodes.size());
                bounds[0] = tree.nodes[0].bounds;
                for (std::size_t n = 0; n < wide.nodes.size(); ++n) {
                    auto children = wide.nodes[n].children();
                    ASSERT_GE(children.size(), 2u);
                    ASSERT_LE(children.size(), static_cast<std::size_t>(width));
                    std::uint32_t next = 0;
                    for (const WideChild& c : children) {
                        EXPECT_TRUE(contains(bounds[n], c.bounds));
                        if (!c.is_leaf()) {
                            ASSERT_GT(c.node, n);
                            EXPECT_TRUE(next == 0 || c.node == next) << "nodes follow one another";
                            next = c.node + 1;
                            ++parents[c.node];
                            bounds[c.node] = c.bounds;
                        }
                        ASSERT_LE(c.leaf.count, max_leaf);
                        for (std::uint32_t k = 0; k < c.leaf.count; ++k) {
                            ++seen[c.leaf.first + k];
                            EXPECT_TRUE(contains(c.bounds, boxes[tree.order[c.leaf.first + k]]));
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
    Exhaustive(const Tree& tree, std::size_t width, std::uint32_t max_leaf, const CollapseCosts& costs)
        : tree_(tree), width_(width), max_leaf_(max_leaf), costs_(costs) {}

    double node(std::size_t i) {
        auto known = nodes_.find(i);
        if (known != nodes_.end()) return known->second;
        double least = 1e30;
        const Tree::Node& n = tree_.nodes[i];
        if (count(i) <= max_leaf_) least = area(n.bounds) * static_cast<double>(leaf_cost(count(i), costs_));
        if (!n.is_leaf()) least = std::min(least, inner(i));
        return nodes_[i] = least;
    }
    double inner(std::size_t i) {
        std::vector<std::size_t> roots{i + 1, tree_.nodes[i].first_or_right};
        return static_cast<double>(costs_.node) * area(tree_.nodes[i].bounds) + cut(roots, 0);
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
    CollapseCosts costs_;
    std::map<std::size_t, double> nodes_;
};

TEST(CollapsedTree, CostsNoMoreThanAnyOtherCut) {
    for (std::uint64_t seed = 0; seed < 10; ++seed)
        for (int width : {4, 8})
            for (CollapseCosts costs : {costs_by_primitive, CollapseCosts{.leaf = 0, .triangle = 2},
                                        CollapseCosts{.leaf = 1.5f, .triangle = 0.1f}}) {
                Triangles t = random_triangles(12 + 4 * seed, 1, 0.5f, 30 + seed);
                Tree tree = tree_of(t, {1, 1});
                CollapsedTree wide = collapse(tree, costs, {.width = width, .leaf_size = 3});
                double least = Exhaustive(tree, static_cast<std::size_t>(width), 3, costs).inner(0);
                EXPECT_NEAR(cost_of(wide, tree.nodes[0].bounds, costs), least, 1e-5 * least);
                EXPECT_NEAR(wide.cost * area(tree.nodes[0].bounds), least, 1e-5 * least);
            }
}

TEST(CollapsedTree, IsTheSameOnAnyNumberOfThreads) {
    Triangles t = random_triangles(60000, 1, 0.02f, 4);
    Tree tree = tree_of(t, {1, 1});
    auto on = [&](int threads) {
        CollapsedTree wide;
        with_threads(threads, [&] { wide = collapse(tree, t, {}, ~0u); });
        return wide;
    };
    CollapsedTree one = on(1), three = on(3);
    ASSERT_EQ(one.nodes.size(), three.nodes.size());
    for (std::size_t n = 0; n < one.nodes.size(); ++n) {
        ASSERT_EQ(one.nodes[n].count, three.nodes[n].count);
        for (std::size_t k = 0; k < one.nodes[n].children().size(); ++k) {
            const WideChild &a = one.nodes[n].child[k], &b = three.nodes[n].child[k];
            ASSERT_EQ(a.node, b.node);
            ASSERT_EQ(a.leaf.first, b.leaf.first);
            ASSERT_EQ(a.leaf.count, b.leaf.count);
        }
    }
}

// Large enough for the parts that are expanded in parallel.
TEST(CollapsedTree, LargeOnesAreWhole) {
    Triangles t = random_triangles(60000, 1, 0.02f, 5);
    Tree tree = tree_of(t, {1, 1});
    CollapsedTree wide = collapse(tree, t, {}, ~0u);
    std::vector<int> seen(tree.order.size(), 0), parents(wide.nodes.size(), 0);
    for (std::size_t n = 0; n < wide.nodes.size(); ++n)
        for (const WideChild& c : wide.nodes[n].children()) {
            if (!c.is_leaf()) {
                ASSERT_GT(c.node, n);
                ++parents[c.node];
            }
            for (std::uint32_t k = 0; k < c.leaf.count; ++k) ++seen[c.leaf.first + k];
        }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), 60000);
    EXPECT_EQ(std::count(parents.begin(), parents.end(), 1), std::ssize(parents) - 1);
}

TEST(CollapsedTree, DearNodesMakeLeavesAndCheapNodesSplitThem) {
    Tree tree = tree_of(random_triangles(200, 1, 0.1f, 2), {1, 1});
    auto leaves = [&](float node) {
        return leaves_of(collapse(tree, {.node = node, .leaf = 0, .triangle = 1}, {.leaf_size = 3}));
    };
    EXPECT_EQ(leaves(0), 200u);
    EXPECT_LT(leaves(10), 150u);
}

TEST(CollapsedTree, OneLeafStandsBelowARootOrAlone) {
    Triangles t = random_triangles(1, 1, 1, 3);
    Tree tree = tree_of(t, {});
    CollapsedTree wide = collapse(tree, costs_by_primitive, {});
    ASSERT_EQ(wide.nodes.size(), 1u);
    ASSERT_EQ(wide.nodes[0].count, 1);
    EXPECT_EQ(wide.nodes[0].child[0].leaf.count, 1u);
    CollapsedTree alone = collapse(tree, t, {}, ~0u);
    EXPECT_EQ(alone.nodes.size(), 0u);
    EXPECT_EQ(alone.single_leaf.count, 1u);
    EXPECT_EQ(collapse(Tree{}, costs_by_primitive, {}).nodes.size(), 0u);
}

TEST(CollapsedTree, LeavesTooLargeAreSplitWhereTheyStand) {
    Tree tree;
    tree.nodes.push_back({{{0, 0, 0}, {1, 1, 1}}, 0, 8});
    for (std::uint32_t i = 0; i < 8; ++i) tree.order.push_back(i);
    CollapsedTree wide = collapse(tree, costs_by_primitive, {.width = 4, .leaf_size = 1});
    std::vector<int> seen(8, 0);
    for (const CollapsedNode& node : wide.nodes.all())
        for (const WideChild& c : node.children()) {
            EXPECT_EQ(c.bounds.hi.x, 1);
            ASSERT_LE(c.leaf.count, 1u);
            if (c.is_leaf()) ++seen[c.leaf.first];
        }
    for (int count : seen) EXPECT_EQ(count, 1);
    EXPECT_LE(wide.depth, 3);
}

TEST(CollapsedTree, LeavesThatMixKindsAreParted) {
    Triangles t = random_triangles(8, 1, 0.5f, 6);
    for (int i = 0; i < 8; ++i)
        t.kinds.push_back(i == 2 || i == 3 ? PrimitiveKind::custom : PrimitiveKind::triangle);
    Tree tree;
    tree.nodes.push_back({{{-2, -2, -2}, {2, 2, 2}}, 0, 8});
    for (std::uint32_t i = 0; i < 8; ++i) tree.order.push_back(i);
    CollapsedTree wide = collapse(tree, t, {}, ~0u);
    std::vector<int> seen(8, 0);
    for (const CollapsedNode& node : wide.nodes.all())
        for (const WideChild& c : node.children())
            for (std::uint32_t k = 0; k < c.leaf.count; ++k) {
                const std::uint32_t p = tree.order[c.leaf.first + k];
                EXPECT_EQ(c.leaf.is_custom, t.kinds[p] == PrimitiveKind::custom);
                ++seen[p];
            }
    for (int count : seen) EXPECT_EQ(count, 1);
}

} // namespace
} // namespace alhazen
