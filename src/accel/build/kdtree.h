/// k-d trees from Morton codes; see kdtree.cpp.
#pragma once

#include "accel/build/tree.h"

namespace alhazen {

/// A tree of cells: planes divide the root's box, so that the leaves' cells fill it without overlapping. A
/// primitive stands in each leaf whose cell it enters, with the box of the part of it that is inside.
struct KdTree {
    static constexpr std::uint8_t leaf_axis = 3;

    struct Node {
        float split = 0; ///< inner node: the plane is where the axis's coordinate is this
        /// Leaf: its first reference. Inner node: the child above the plane; the child below is the next
        /// node.
        std::uint32_t first_or_above = 0;
        std::uint32_t count = 0;       ///< references of a leaf, which may have none
        std::uint8_t axis = leaf_axis; ///< 0, 1 or 2 of the plane's normal; leaf_axis for a leaf
        bool is_leaf() const { return axis == leaf_axis; }
    };
    struct Reference {
        /// Around the part inside the leaf's cell, padded as the whole primitive is.
        Bounds3 bounds;
        std::uint32_t primitive = 0;
    };
    Bounds3 cell;                      ///< the root's
    std::vector<Node> nodes;           ///< depth first; none: no primitives
    std::vector<Reference> references; ///< leaf after leaf
};

struct KdOptions {
    int bits = 21; ///< for each axis: planes are where a grid of 2^bits cells has them (1 ... 21)
    /// Cells are no longer divided when that would give more references than this for each primitive (>= 1).
    float max_references = 6;
};

/// boxes: as padded_boxes gives them for the primitives. Costs are those of the build options.
KdTree build_kdtree(const Primitives& primitives, std::span<const Bounds3> boxes, const BuildOptions& options,
                    const KdOptions& kd_options = {});

/// The same hierarchy by boxes: a node's box is around the parts of primitives in its cell.
Tree to_tree(const KdTree& kdtree, const BuildOptions& options);

} // namespace alhazen
