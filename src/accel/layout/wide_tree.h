/// Wide trees, made from binary ones by leaving nodes out so that the expected cost of a ray is least.
///
/// A node with eight children saves a ray most of the steps down, if the right nodes are left out. Ylitie,
/// Karras and Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs",
/// section 3.1, find the best choice: from the leaves up, each binary node learns what it costs to stand as a
/// forest of 1, 2, ... 7 wide trees; a forest of i is the best forest of k on the left beside the best of
/// i - k on the right, and a wide node is a forest of as many trees as it has room for. Picture: scissors go
/// along the branches of the binary tree and cut it into pieces, each of which becomes one node.
#pragma once

#include <span>

#include "accel/build/tree.h"

namespace alhazen {

/// What the collapse weighs against each other; the defaults are the paper's.
struct CollapseCost {
    float node = 1.0f;      ///< of visiting a wide node
    float primitive = 0.3f; ///< of testing one primitive
};

/// A tree whose nodes have up to max_width children. Leaves are runs of the binary tree's order.
struct WideTree {
    static constexpr int max_width = 8;
    /// Edges from the root to a leaf at most: leaves too large for a slot are halved up to three times.
    static constexpr int max_depth = Tree::max_depth + 3;

    struct Child {
        Bounds3 bounds;
        std::uint32_t index = 0; ///< leaf: its first place in the order; else number of a node
        std::uint32_t count = 0; ///< primitives of a leaf; 0 for a node
        bool is_leaf() const { return count > 0; }
    };
    struct Node {
        std::uint32_t first_child = 0, child_count = 0;
    };
    /// The root first (also above a single leaf), parents before children; those children of a node that are
    /// nodes follow one another. Empty when the binary tree is.
    std::vector<Node> nodes;
    std::vector<Child> children;
    int depth = 0; ///< edges from the root to the deepest leaf

    std::span<const Child> children_of(const Node& node) const {
        return std::span(children).subspan(node.first_child, node.child_count);
    }
};

/// The wide tree (2 <= width <= WideTree::max_width) of least cost whose nodes are nodes of the binary tree.
/// Leaves hold up to max_leaf (>= 1) primitives: subtrees of so few may become one leaf, and leaves of more
/// become several, with the same box.
WideTree collapse(const Tree& tree, int width, std::uint32_t max_leaf, const CollapseCost& cost = {});

} // namespace alhazen
