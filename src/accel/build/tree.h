/// What every builder gives and every layout is made from: a binary tree of boxes over an order of the
/// primitives.
#pragma once

#include <cstdint>
#include <vector>

#include "base/bounds.h"

namespace alhazen {

/// A bounding volume hierarchy. Node 0 is the root; no nodes: no primitives.
struct Tree {
    /// No path from the root to a leaf has more edges than this: walks keep stacks of this size. Builders see
    /// to it.
    static constexpr int max_depth = 80;
    /// Leaves hold at most this many primitives.
    static constexpr std::uint32_t max_leaf_size = 8;

    struct Node {
        Bounds3 bounds;
        /// Leaf: its first place in order. Inner node: its right child; the left child is the next node.
        std::uint32_t first_or_right = 0;
        std::uint32_t count = 0; ///< primitives of a leaf; 0 for an inner node
        bool is_leaf() const { return count > 0; }
    };
    std::vector<Node> nodes; ///< in depth-first order
    /// Primitive numbers, leaf after leaf. Primitives whose box is empty or not finite are left out.
    std::vector<std::uint32_t> order;
};

} // namespace alhazen
