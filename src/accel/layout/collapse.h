/// From binary trees to wide ones: which subtrees become leaves, and which nodes are left out so that their
/// children move up to the node above.
///
/// A node with eight children saves a ray most of the steps down, if the right nodes are left out. Ylitie,
/// Karras and Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs",
/// section 3.1, find the best choice by dynamic programming: from the leaves up, each binary node learns what
/// it costs when it may take 1, 2, ... 8 of the places of the wide node above it; with i places, k go to the
/// left child and i - k to the right one, and a new wide node takes one place and has eight to give. Picture:
/// scissors go along the branches of the binary tree and cut it into pieces, each of which becomes one node.
#pragma once

#include <array>
#include <span>

#include "accel/build/tree.h"
#include "base/big_array.h"

namespace alhazen {

/// Primitives that are tested together: a run of the tree's order.
struct WideLeaf {
    std::uint32_t first = 0, count = 0;
    bool is_custom = false; ///< else triangles, plain and filtered; where kinds matter
};

/// One place of a wide node.
struct WideChild {
    Bounds3 bounds;
    WideLeaf leaf;          ///< count 0: a node
    std::uint32_t node = 0; ///< number in the list of nodes
    bool is_leaf() const { return leaf.count > 0; }
};

struct CollapsedNode {
    static constexpr int most_children = 8;

    std::array<WideChild, most_children> child;
    int count = 0; ///< of children

    std::span<const WideChild> children() const { return {child.data(), static_cast<std::size_t>(count)}; }
};

/// The wide tree before it is written to memory.
struct CollapsedTree {
    /// Edges from the root to a leaf at most: leaves too large for a place are halved up to three times.
    static constexpr int max_depth = Tree::max_depth + 3;

    /// The root first, parents before their children; those children of a node that are nodes follow one
    /// another.
    BigArray<CollapsedNode> nodes;
    WideLeaf single_leaf;    ///< count > 0: there is one leaf only, and no node
    int depth = 0;           ///< edges from the root to the deepest leaf
    std::uint32_t stack = 0; ///< entries that a walk needs at most, sentinel and top included
    double cost = 0;         ///< expected, in node visits; by the model it was chosen by
};

/// What the choice weighs against each other. By default leaves cost the same whatever they hold, as where
/// all their triangles are tested at once.
struct CollapseCosts {
    float node = 1;     ///< of visiting a node
    float leaf = 1;     ///< of visiting a leaf of triangles
    float triangle = 0; ///< of testing one, more than that
    float custom = 1;   ///< of testing a primitive that is no triangle
};
/// Those of the article, which tests primitives one by one.
inline constexpr CollapseCosts costs_by_primitive{.leaf = 0, .triangle = 0.3f};

/// What nodes and leaves of a layout are like.
struct WideShape {
    int width = CollapsedNode::most_children; ///< children of a node (2 ... 8)
    std::uint32_t leaf_size = 8;              ///< primitives of a leaf (>= 1)
    std::uint32_t stack = ~0u;  ///< entries of the stack; at least what a tree collapsed by height needs
    bool has_lone_leaf = false; ///< a tree of one leaf is single_leaf; else a node above it
    /// A node's children from the smallest to the largest; else as in the binary tree.
    bool by_size = false;
};

/// The tree of least cost whose nodes are nodes of the binary tree, for walks that test all primitives alike
/// (at costs.triangle). Leaves of the tree that are too large become several, with the same box. A very deep
/// tree, whose walk would need more than the stack holds, is collapsed by height instead of cost.
CollapsedTree collapse(const Tree& tree, const CollapseCosts& costs, const WideShape& shape);

/// The same for leaves of either triangles or others: of eight primitives, in nodes of eight children that
/// are ordered by size. A tree whose leaves mix them is no obstacle.
CollapsedTree collapse(const Tree& tree, const Primitives& primitives, const CollapseCosts& costs,
                       std::uint32_t stack_limit);

} // namespace alhazen
