/// From a binary tree to nodes of eight children: which subtrees become leaves, and which nodes are merged.
///
/// Chosen at least expected cost, by dynamic programming from the leaves up: what a subtree costs when it may
/// use 1, 2, ... 8 of its parent's places (Ylitie, Karras and Laine 2017, section 3.1). A leaf costs the same
/// whatever it holds, since eight triangles are tested at once.
#pragma once

#include <array>
#include <vector>

#include "accel/build/tree.h"

namespace alhazen {

/// Primitives that are tested together: a run of the tree's order.
struct WideLeaf {
    std::uint32_t first = 0, count = 0;
    bool is_custom = false; ///< else triangles, plain and filtered
};

/// One place of a wide node.
struct WideChild {
    Bounds3 bounds;
    WideLeaf leaf;          ///< count 0: a node
    std::uint32_t node = 0; ///< number in the list of nodes
    bool is_leaf() const { return leaf.count > 0; }
};

struct CollapsedNode {
    std::array<WideChild, 8> child;
    int count = 0; ///< of children
};

/// The wide tree before it is written to memory.
struct CollapsedTree {
    std::vector<CollapsedNode> nodes; ///< parents before their children; the root is the first
    WideLeaf single_leaf;             ///< count > 0: there is one leaf only, and no node
    int depth = 0;                    ///< edges from the root to the deepest leaf
    std::uint32_t stack = 0;          ///< entries that a walk needs at most, sentinel and top included
    double cost = 0;                  ///< expected, in node visits; by the model it was chosen by
};

struct CollapseCosts {
    float node = 1;   ///< of visiting a node
    float leaf = 1;   ///< of testing up to eight triangles
    float custom = 1; ///< of testing a primitive that is no triangle
};

/// A tree whose leaves mix triangles and others is no obstacle. The result needs no more than stack_limit
/// entries: a very deep tree is collapsed by height instead of cost.
CollapsedTree collapse(const Tree& tree, const Primitives& primitives, const CollapseCosts& costs,
                       std::uint32_t stack_limit);

} // namespace alhazen
