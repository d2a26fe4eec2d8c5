/// Trees while they are being made: nodes that stand anywhere and name their children, as bottom-up builders
/// and optimisers need them, and the way from there to a Tree.
///
/// On that way subtrees become leaves where that is cheaper. A builder that works from the bottom up starts
/// with leaves of one primitive; what a leaf of several costs against the subtree in its place is known
/// exactly by then, so that of all trees that differ only in this, the cheapest results.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "accel/build/tree.h"
#include "base/big_array.h"

namespace alhazen {

struct LinkedTree {
    /// Without initial values, since there are many and each is written once.
    struct Node {
        std::array<float, 3> lo, hi; ///< of leaves; finish() sets those of inner nodes
        std::uint32_t left;          ///< inner node: its left child; leaf: its first place in order
        std::uint32_t right;         ///< inner node: its right child
        std::uint32_t count;         ///< primitives of a leaf; 0 for an inner node

        bool is_leaf() const { return count > 0; }
        Bounds3 bounds() const { return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}}; }
        void set_bounds(const Bounds3& b) {
            lo = {b.lo.x, b.lo.y, b.lo.z};
            hi = {b.hi.x, b.hi.y, b.hi.z};
        }
        void make_leaf(const Bounds3& b, std::uint32_t first, std::uint32_t primitives) {
            set_bounds(b);
            left = first;
            right = 0;
            count = primitives;
        }
        void make_inner(std::uint32_t left_child, std::uint32_t right_child) {
            left = left_child;
            right = right_child;
            count = 0;
        }
    };
    BigArray<Node> nodes; ///< empty: no tree
    std::uint32_t root = 0;
    std::vector<std::uint32_t> order; ///< primitive numbers
};

/// The same tree, node for node.
LinkedTree linked(Tree&& tree);

/// The tree in depth-first order, with subtrees of up to options.leaf_size primitives made leaves where that
/// lowers the cost of the surface area heuristic. With a leaf_size of 1 every leaf stays as it is. No path
/// may be longer than Tree::max_depth.
Tree finish(LinkedTree&& linked, const BuildOptions& options);

/// Makes leaves of a finished tree's subtrees in the same way.
void collapse_leaves(Tree& tree, const BuildOptions& options);

} // namespace alhazen
