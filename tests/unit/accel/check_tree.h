/// What every tree must be, whoever built it.
#pragma once

#include <gtest/gtest.h>

#include <cstring>

#include "accel/build/tree.h"
#include "base/threads.h"

namespace alhazen::accel_test {

inline bool contains(const Bounds3& outer, const Bounds3& inner) {
    return outer.contains(inner.lo) && outer.contains(inner.hi);
}

/// Depth-first nodes, every node inside its parent, leaves neither too large nor beyond the order, no path
/// longer than promised; visit_leaf(node) for each leaf. Returns the depth.
template <class VisitLeaf>
int check_shape(const Tree& tree, const VisitLeaf& visit_leaf) {
    if (tree.nodes.empty()) return 0;
    struct Visit {
        std::size_t node;
        int depth;
    };
    std::vector<Visit> stack{{0, 0}};
    std::size_t visited = 0;
    int deepest = 0;
    std::uint32_t next_place = 0;
    while (!stack.empty()) {
        auto [i, depth] = stack.back();
        stack.pop_back();
        // The left child is taken first, so this is the order in memory.
        EXPECT_EQ(i, visited);
        ++visited;
        deepest = std::max(deepest, depth);
        const Tree::Node& n = tree.nodes[i];
        if (n.is_leaf()) {
            EXPECT_LE(n.count, Tree::max_leaf_size);
            EXPECT_EQ(n.first_or_right, next_place);
            next_place += n.count;
            EXPECT_LE(n.first_or_right + n.count, tree.order.size());
            visit_leaf(n);
            continue;
        }
        for (std::size_t child : {static_cast<std::size_t>(n.first_or_right), i + 1}) {
            if (child <= i || child >= tree.nodes.size()) {
                ADD_FAILURE() << "node " << i << " has no child " << child;
                return deepest;
            }
            EXPECT_TRUE(contains(n.bounds, tree.nodes[child].bounds));
            stack.push_back({child, depth + 1});
        }
    }
    EXPECT_EQ(visited, tree.nodes.size());
    EXPECT_LE(deepest, Tree::max_depth);
    return deepest;
}

/// The same of a tree that splits no primitives: every box that is not empty is in one leaf, which holds it.
inline int check_tree_of_boxes(const Tree& tree, const std::vector<Bounds3>& boxes) {
    std::vector<int> seen(boxes.size(), 0);
    int depth = check_shape(tree, [&](const Tree::Node& leaf) {
        for (std::uint32_t k = 0; k < leaf.count; ++k) {
            std::uint32_t p = tree.order[leaf.first_or_right + k];
            ++seen[p];
            EXPECT_TRUE(contains(leaf.bounds, boxes[p]));
        }
    });
    for (std::size_t i = 0; i < boxes.size(); ++i) EXPECT_EQ(seen[i], boxes[i].empty() ? 0 : 1) << i;
    return depth;
}

/// build(), which gives a tree, gives the same bits on 1, 2 and 3 threads.
template <class Build>
void expect_same_on_any_threads(const Build& build) {
    Tree first;
    for (int threads : {1, 2, 3}) {
        Tree tree;
        with_threads(threads, [&] { tree = build(); });
        if (threads == 1) first = tree;
        ASSERT_EQ(tree.nodes.size(), first.nodes.size());
        const std::size_t bytes = tree.nodes.size() * sizeof(Tree::Node);
        EXPECT_EQ(std::memcmp(tree.nodes.data(), first.nodes.data(), bytes), 0) << threads << " threads";
        EXPECT_EQ(tree.order, first.order);
    }
}

} // namespace alhazen::accel_test
