/// Bins: where a split of a node's references costs least, found by counting them into a few slices.
///
/// Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies": the centres of a node's boxes
/// fall into equal slices along each axis; the planes between slices are the candidates. A split costs (area
/// of the left box) x (tests in it) + the same on the right, as a random ray that meets the node meets a
/// child with probability proportional to the child's area. Here the three axes are the lanes of one
/// register.
#pragma once

#include <array>
#include <cmath>

#include "accel/build/references.h"

namespace alhazen {

/// What testing n primitives costs, in tests: they are tested a block at a time.
class TestCount {
  public:
    explicit TestCount(std::uint32_t block)
        : inverse_(1 / static_cast<float>(block)), offset_(static_cast<float>(block) - 0.5f),
          is_one_(block <= 1) {}

    /// ceil(n / block).
    Lanes4 operator()(IntLanes4 n) const {
        Lanes4 count = __builtin_convertvector(n, Lanes4);
        if (is_one_) return count;
        Lanes4 blocks = (count + all_lanes(offset_)) * all_lanes(inverse_);
        return __builtin_convertvector(__builtin_convertvector(blocks, IntLanes4), Lanes4);
    }
    float operator()(std::size_t n) const { return (*this)(all_int_lanes(static_cast<int>(n)))[0]; }

  private:
    float inverse_, offset_;
    bool is_one_;
};

/// Which slice a point falls into, on the three axes at once.
struct BinGrid {
    Lanes4 origin, scale; ///< the fourth lanes are 0
    int size;             ///< slices

    /// Along axes without extent, or with one that floats cannot count, everything falls into slice 0.
    BinGrid(const LaneBox& extent, int bins) : origin(extent.lo), scale(all_lanes(0)), size(bins) {
        origin[3] = 0;
        Lanes4 length = extent.hi - extent.lo;
        for (int axis = 0; axis < 3; ++axis) {
            float s = static_cast<float>(bins) / length[axis];
            if (std::isfinite(length[axis]) && std::isfinite(s) && length[axis] > 0) scale[axis] = s;
        }
    }
    bool splits(int axis) const { return scale[axis] > 0; }
    /// In units of slices.
    Lanes4 place(Lanes4 p) const { return (p - origin) * scale; }
    /// 0 ... size - 1.
    IntLanes4 slice(Lanes4 place) const {
        Lanes4 last = all_lanes(static_cast<float>(size - 1));
        // NaN, from infinities, becomes 0.
        return __builtin_convertvector(min_lanes(max_lanes(place, all_lanes(0)), last), IntLanes4);
    }
    /// Where slice k begins.
    float plane(int axis, int k) const { return origin[axis] + static_cast<float>(k) / scale[axis]; }
};

/// For each axis and slice: a box and how many references begin and end there. The two counts differ when
/// references are chopped at the slices' borders.
struct Bins {
    static constexpr int max_size = 32;

    struct Bin {
        std::array<RawBox, 3> box; ///< one an axis
        alignas(16) std::array<std::int32_t, 4> enter, leave;
    };
    std::array<Bin, max_size> bin;

    /// Must be called first: as constructed, nothing is set.
    void clear(int size) {
        for (int b = 0; b < size; ++b) {
            for (RawBox& box : (*this)[b].box) box.clear();
            (*this)[b].enter = (*this)[b].leave = {0, 0, 0, 0};
        }
    }
    Bin& operator[](int b) { return bin[static_cast<std::size_t>(b)]; }
    const Bin& operator[](int b) const { return bin[static_cast<std::size_t>(b)]; }

    /// Counts references by their centres; enter is leave, and only enter is kept.
    void add(std::span<const Reference> references, const BinGrid& grid);
    /// other has been filled over the same grid.
    void join(const Bins& other, int size);
};

/// A way to split a node at the border below slice bin.
struct BinSplit {
    int axis = -1; ///< -1: there is none
    int bin = 0;
    float cost = infinity; ///< sum over children of area x tests
    LaneBox left, right;
    std::size_t left_count = 0, right_count = 0;

    bool found() const { return axis >= 0; }
};

/// The best split of all axes: of references counted by their centres, or of chopped ones.
BinSplit best_object_split(const Bins& bins, const BinGrid& grid, const TestCount& tests);
BinSplit best_chopped_split(const Bins& bins, const BinGrid& grid, const TestCount& tests);

} // namespace alhazen
