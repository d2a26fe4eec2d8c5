/// Octrees from Morton codes; see octree.cpp.
#pragma once

#include <bit>

#include "accel/build/morton.h"
#include "accel/build/tree.h"

namespace alhazen {

/// A tree of cubes: a cell of level k is one of the 8^k that halving the root's cube k times gives. The
/// primitives of a cell are those whose centroid is in it, so their boxes may reach beyond it.
struct Octree {
    struct Node {
        Bounds3 bounds;           ///< of the cell's primitives, not of the cell
        std::uint64_t prefix = 0; ///< the cell's place: the 3 level highest bits of its primitives' codes
        std::uint32_t begin = 0;  ///< its primitives are at these places of order
        std::uint32_t end = 0;    ///< one behind the last
        std::uint32_t first_child = 0; ///< children stand side by side, by octant
        std::uint8_t child_mask = 0;   ///< which octants have primitives; 0: not divided
        std::uint8_t level = 0;        ///< 0 for the root

        std::uint32_t count() const { return end - begin; }
        bool is_leaf() const { return child_mask == 0; }
        bool has_child(int octant) const { return child_mask >> octant & 1; }
        /// Octant: 4 for the upper half in x, plus 2 for y, plus 1 for z. has_child(octant) must be true.
        std::uint32_t child(int octant) const {
            return first_child + static_cast<std::uint32_t>(std::popcount(child_mask & ((1u << octant) - 1)));
        }
    };
    int max_level = 0;                ///< bits of the codes over 3
    std::vector<Node> nodes;          ///< the root is number 0; none: no primitives
    std::vector<std::uint32_t> order; ///< primitive numbers along the curve
    std::vector<std::uint64_t> codes; ///< one a place of order
};

struct OctreeOptions {
    int max_level = 21; ///< 1 ... 21
    /// Cells with so many primitives or fewer are not divided; 0: all are, down to max_level.
    std::uint32_t leaf_size = 8;
};

/// boxes: as padded_boxes gives them.
Octree build_octree(std::span<const Bounds3> boxes, const OctreeOptions& options = {});

/// The same hierarchy with two children a node: a cell is halved in x, its halves in y, their halves in z.
Tree to_tree(const Octree& octree, std::span<const Bounds3> boxes, const BuildOptions& options);

} // namespace alhazen
