/// Binary nodes that hold the boxes of both children: one node is one cache line, and one test tells which
/// children to visit and in which order (Aila and Laine 2009).
///
///     byte  0        16        32        48         56
///           x slabs   y slabs   z slabs   child refs  counts
///           lo lo hi hi   ...             left right  left right
#pragma once

#include <cstdint>
#include <vector>

#include "accel/structure.h"

namespace alhazen {

/// A child: a leaf's range in the order, or a node.
struct BinaryChild {
    std::uint32_t index = 0; ///< leaf: first place in the order; else number of a node
    std::uint32_t count = 0; ///< leaf: primitives; 0 for a node
};

struct alignas(64) BinaryNode {
    float slabs[3][2][2]; ///< axis; 0 lower, 1 upper; 0 left, 1 right child
    std::uint32_t index[2];
    std::uint32_t count[2];

    BinaryChild child(int i) const { return {index[i], count[i]}; }
};
static_assert(sizeof(BinaryNode) == 64);

struct BinaryLayout {
    std::vector<BinaryNode> nodes; ///< depth first
    BinaryChild root;              ///< a leaf when there is one leaf only
    int depth = 0;

    BinaryLayout() = default;
    explicit BinaryLayout(const Tree& tree);
    LayoutStats stats() const { return {nodes.size(), depth, nodes.size() * sizeof(BinaryNode)}; }
};

} // namespace alhazen
