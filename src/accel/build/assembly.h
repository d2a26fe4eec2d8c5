/// Putting a tree together that was built in many places at once.
///
/// Small subtrees are built by one thread each and come as runs of nodes that are in depth-first order
/// already, with numbers that start at 0; above them are a few nodes that many threads have worked on.
#pragma once

#include <vector>

#include "accel/build/tree.h"

namespace alhazen {

/// A subtree while it is written.
struct Run {
    std::vector<Tree::Node> nodes;
    std::vector<std::uint32_t> order;

    /// For about so many references.
    explicit Run(std::size_t references = 0) {
        nodes.reserve(references + references / 8);
        order.reserve(references);
    }
    /// Appends a node and returns its number. If it is an inner one, its left child comes next.
    std::uint32_t add_node(const Bounds3& bounds) {
        nodes.push_back({bounds, 0, 0});
        return static_cast<std::uint32_t>(nodes.size() - 1);
    }
    /// The next node is the right child of this one.
    void begin_right(std::uint32_t node) {
        nodes[node].first_or_right = static_cast<std::uint32_t>(nodes.size());
    }
    /// Makes the node a leaf; its primitives are appended next.
    void make_leaf(std::uint32_t node, std::size_t count) {
        nodes[node].first_or_right = static_cast<std::uint32_t>(order.size());
        nodes[node].count = static_cast<std::uint32_t>(count);
    }
    void add_primitive(std::uint32_t primitive) { order.push_back(primitive); }
};

/// A piece of the whole tree: a run, or an inner node.
struct Part {
    Run run;               ///< without nodes for an inner node
    Bounds3 bounds;        ///< of an inner node
    std::size_t right = 0; ///< the part where an inner node's right child begins, counted from the node's own
};
/// In depth-first order.
using Parts = std::vector<Part>;

Parts parts_of(Run run);
/// An inner node over two subtrees.
Parts join_parts(const Bounds3& bounds, Parts left, Parts right);

Tree assemble(const Parts& parts);

} // namespace alhazen
