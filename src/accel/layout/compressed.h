/// Eight-wide nodes of 80 bytes: Ylitie, Karras and Laine 2017, "Efficient Incoherent Ray Traversal on GPUs
/// Through Compressed Wide BVHs", sections 3 and 4.
///
/// A node lays a grid of 256 steps over its box, each axis with a power of two as its step, and the boxes of
/// its children are given in steps, a byte a plane, rounded outwards. The children that are nodes stand one
/// after another, and so do the primitives of those that are leaves (three at most each, 24 a node), so one
/// base for each and a byte a child are all that is needed to find them. Children sit in the slots that make
/// a fixed order good: slot s is for the child that a ray from octant s should meet first, and a ray visits
/// slot s ^ octant in falling order, without sorting.
///
///     byte  0       12        15          16           20               24    32           56
///           origin  exponent  inner mask  first child  first primitive  meta  lower x y z  upper x y z
///           3 x 4   3 x 1     1           4            4                8 x 1 3 x 8 x 1    3 x 8 x 1
///
/// The article assigns children to slots by the auction algorithm; here the best assignment is found by going
/// through sets of slots, which for eight is as quick and never worse.
#pragma once

#include <array>
#include <bit>

#include "accel/layout/collapse.h"
#include "accel/structure.h"

namespace alhazen {

struct alignas(16) CompressedNode {
    static constexpr int slots = 8;
    static constexpr std::uint32_t max_leaf = 3; ///< primitives of one slot

    float origin[3];          ///< the box's lower corner
    std::uint8_t exponent[3]; ///< of the grid's steps, as in a float
    std::uint8_t inner_mask;  ///< slots that hold nodes
    std::uint32_t first_child;
    std::uint32_t first_primitive;
    /// A slot's meta byte. Empty: 0. Node: 001 in the upper bits, 24 + slot below. Leaf: a 1 for each
    /// primitive in the upper bits, below the place of the first one, from first_primitive on.
    std::uint8_t meta[slots];
    std::uint8_t planes[2][3][slots]; ///< lower, upper; axis; in steps from origin

    float step(int axis) const {
        return std::bit_cast<float>(static_cast<std::uint32_t>(exponent[axis]) << 23);
    }
    /// Where a plane is. The walk computes the same bits.
    float plane(int side, int axis, int slot) const {
        return origin[axis] + static_cast<float>(planes[side][axis][slot]) * step(axis);
    }
    bool is_inner(int slot) const { return (inner_mask >> slot & 1) != 0; }
    /// The number of the node in a slot.
    std::uint32_t child(int slot) const {
        const unsigned before = inner_mask & ((1u << slot) - 1);
        return first_child + static_cast<std::uint32_t>(std::popcount(before));
    }
};
static_assert(sizeof(CompressedNode) == 80);

struct CompressedLayout {
    std::vector<CompressedNode> nodes; ///< 0 is the root
    /// The tree's order, rearranged so that the primitives of a node's leaves stand together.
    std::vector<std::uint32_t> order;
    int depth = 0;

    CompressedLayout() = default;
    explicit CompressedLayout(const Tree& tree);
    LayoutStats stats() const { return {nodes.size(), depth, nodes.size() * sizeof(CompressedNode)}; }
};

/// The slot for each of at most 8 children of a node, each slot used once: so that the sum over children of
/// dot(child's centroid - node's centroid, direction of the slot) is least, where the direction of slot s is
/// -1 along the axes whose bit is set in s and +1 along the others (section 3.3 of the article).
std::array<int, CompressedNode::slots> assign_slots(std::span<const WideChild> children);

} // namespace alhazen
