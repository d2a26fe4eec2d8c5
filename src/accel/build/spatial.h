/// Splits of space: a primitive that straddles the plane goes to both children, each with the box of its own
/// piece.
///
/// Stich, Friedrich and Dietrich 2009, "Spatial Splits in Bounding Volume Hierarchies". Picture a long
/// diagonal beam: its box is mostly empty, and whatever is in there overlaps it; cut in pieces, its boxes
/// follow it. Candidates are the borders between slices of the node's box; into each slice goes what the
/// slice holds of every primitive ("chopped binning", section 4.2). A reference whose pieces would cost more
/// than putting it to one side whole stays whole ("reference unsplitting", section 4.4).
#pragma once

#include "accel/build/binning.h"
#include "accel/primitives.h"

namespace alhazen {

/// What a plane leaves of something on either side; a side may be empty.
struct Pieces {
    LaneBox left, right;
};

/// The shapes of all primitives, kept close together, and how they are cut.
///
/// Pieces are as safe as whole boxes (padded_boxes): each contains all points closer than the padding of the
/// whole box to the part of the primitive on its side, and inside the reference's box. So a ray that the
/// primitive's test takes for a hit, though it misses by rounding, meets one of the boxes.
class Shapes {
  public:
    /// boxes: as padded_boxes gives them.
    Shapes(const Primitives& primitives, std::span<const Bounds3> boxes);

    /// Safe boxes around both sides of a reference.
    Pieces cut(const Reference& reference, int axis, float plane) const;
    /// The boxes around what slices first ... last along an axis hold of a reference, added to the bins. Not
    /// padded: for costs.
    void chop(const Reference& reference, const BinGrid& grid, int axis, int first, int last,
              Bins& bins) const;

  private:
    // A triangle's corners. Of something else (and of triangles too huge or tiny to compute with): its whole
    // box's corners b and c; then a.x is NaN.
    BigArray<Corners> shapes_;
};

/// A split of space. Counts and boxes are what they would be without unsplitting.
struct SpatialSplit {
    BinSplit split;
    BinGrid grid{LaneBox{}, 1};

    float cost() const { return split.cost; }
};

/// What became of a node's references.
struct SpatialChildren {
    std::size_t left_count = 0, right_count = 0;
    Extent left, right;
};

class SpatialSplitter {
  public:
    /// root: the box of everything.
    SpatialSplitter(const Primitives& primitives, std::span<const Bounds3> boxes, const LaneBox& root)
        : shapes_(primitives, boxes), least_overlap_(alpha * root.half_area()) {}

    /// A split that costs less than the best split of objects and adds at most spare references; costs
    /// infinity when there is none, or when the children of the split of objects hardly overlap
    /// (section 4.5).
    SpatialSplit find(std::span<const Reference> references, const LaneBox& box, const BinSplit& objects,
                      std::size_t spare, const TestCount& tests) const;
    /// Writes the left child's references to the begin of the room and the right child's to its end.
    SpatialChildren partition(std::span<const Reference> references, const SpatialSplit& split,
                              std::span<Reference> room) const;

  private:
    // Overlap that is worth a try, as a fraction of the root's area.
    static constexpr float alpha = 1e-5f;

    struct Parted {
        bool is_left, is_right; // both for a reference that is cut
        Reference left, right;
    };
    Parted part(const Reference& reference, const SpatialSplit& split) const;
    void chop(std::span<const Reference> references, const BinGrid& grid, Bins& bins) const;
    SpatialChildren partition_run(std::span<const Reference> references, const SpatialSplit& split,
                                  Reference* left, Reference* right, std::ptrdiff_t right_step) const;

    Shapes shapes_;
    float least_overlap_;
};

} // namespace alhazen
