/// What every builder gives and every layout is made from: a binary tree of boxes over an order of the
/// primitives.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "accel/primitives.h"

namespace alhazen {

/// A bounding volume hierarchy. Node 0 is the root; no nodes: no primitives.
struct Tree {
    /// No path from the root to a leaf has more edges than this: walks keep stacks of this size. Builders see
    /// to it. (The longest that cannot be avoided: 63 bits of Morton code and 32 of number.)
    static constexpr int max_depth = 96;
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
    /// Primitive numbers, leaf after leaf as the leaves follow one another among the nodes: any subtree's
    /// primitives are a run. A primitive that was split stands there more than once; those
    /// whose box is empty are left out.
    std::vector<std::uint32_t> order;
};

/// What a builder is asked for.
struct BuildOptions {
    /// Cost of visiting a node over the cost of testing one primitive.
    float node_cost = 1.0f;
    /// A node with so many primitives or fewer may become a leaf (1 ... Tree::max_leaf_size).
    std::uint32_t leaf_size = 4;
    /// Primitives that the walk tests at once: a leaf of n costs ceil(n / block) tests.
    std::uint32_t block = 1;
    /// How many primitives the layout itself joins in a leaf, at the cost of one test (0: it does not).
    /// Builders need not choose with care what is in there: such a run, or half of it, may come as one leaf.
    std::uint32_t joined = 0;
    /// References that spatial splits may add, as a fraction of the primitives (>= 0).
    float extra_references = 0.3f;
};

/// Figures by which trees are compared.
struct TreeStats {
    std::size_t nodes = 0;      ///< inner nodes and leaves
    std::size_t leaves = 0;     ///< of these
    std::size_t references = 0; ///< places in the order; more than primitives where some were split
    int depth = 0;              ///< edges from the root to the deepest leaf
    /// Expected cost of a random ray that meets the root's box, in tests of primitives: the sum over inner
    /// nodes of (node cost) x area + over leaves of ceil(count / block) x area, over the root's area
    /// (MacDonald and Booth 1990).
    double sah_cost = 0;
};
TreeStats stats_of(const Tree& tree, float node_cost = 1.0f, std::uint32_t block = 1);

/// End-point overlap (Aila, Karras and Laine 2013, "On Quality Metrics of Bounding Volume Hierarchies",
/// section 3): the same sum over the area of the primitives' surface inside each node that does not belong to
/// the node, over the area of all surface. Estimated from points sampled on the triangles (all custom
/// primitives count as their boxes' surface).
double end_point_overlap(const Tree& tree, const Primitives& primitives, std::size_t samples = 20000);

/// Fits the tree's boxes to primitives that have moved (boxes as padded_boxes gives them); the tree's shape
/// stays. Primitives that were split get their whole box in each place; those that cannot be hit any more
/// keep a place without extent. False, and the tree as it was, where that is not enough and the tree must be
/// built anew: a primitive that stands nowhere in it can be hit now, or none can.
bool refit(Tree& tree, std::span<const Bounds3> boxes);

} // namespace alhazen
