/// Parting a node's references into those of its children, from one array into another: each reference is
/// read once and written once, without a branch that depends on it.
#pragma once

#include <cstddef>

#include "accel/build/binning.h"

namespace alhazen {

/// Where a node's references are: data in some place of a room that it may fill.
struct Range {
    std::size_t begin = 0, end = 0;           ///< references
    std::size_t room_begin = 0, room_end = 0; ///< places; room_begin <= begin, end <= room_end
    int side = 0;                             ///< which of the two arrays

    std::size_t size() const { return end - begin; }
    /// References that may be added.
    std::size_t spare() const { return room_end - room_begin - size(); }
};

/// Where the references of two children go next: places of an array.
struct Cursors {
    Reference* array;
    std::ptrdiff_t left, right;
    std::ptrdiff_t right_step; ///< 1, or -1 to fill the room from its end

    /// Puts the reference to the left where the mask is -1, to the right where it is 0.
    void put(const Reference& r, std::ptrdiff_t left_mask) {
        array[right ^ ((left ^ right) & left_mask)] = r;
        left -= left_mask;
        right += right_step & ~left_mask;
    }
};

/// The boxes around the centres of two children's references.
struct ChildCentroids {
    LaneBox left, right;

    void join(const ChildCentroids& other) {
        left.extend(other.left);
        right.extend(other.right);
    }
};

/// Parts by the slice of the centre along an axis: left of slice bin goes left.
void partition_by_slice(std::span<const Reference> references, const BinGrid& grid, int axis, int bin,
                        Cursors& to, ChildCentroids& centroids);

/// The ranges of two children in the other array, when left_count and right_count references are written to
/// the ends of the parent's room; what room is left over is divided in proportion.
struct ChildRanges {
    Range left, right;
};
ChildRanges child_ranges(const Range& parent, std::size_t left_count, std::size_t right_count);

} // namespace alhazen
