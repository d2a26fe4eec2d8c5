/// Morton codes: points of space put in a line so that neighbours in the line are neighbours in space (Morton
/// 1966, "A computer oriented geodetic data base"). The bits of the three coordinates take turns, so that the
/// line visits the eight octants of space one after another, and within each octant its eight octants, and so
/// on: sorting points by their codes is the same as putting them into an octree.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/bounds.h"

namespace alhazen {

/// Spreads the lowest 21 bits so that two zeros stand above each.
inline std::uint64_t spread_bits(std::uint64_t v) {
    v &= 0x1fffff;
    v = (v | v << 32) & 0x001f00000000ffff;
    v = (v | v << 16) & 0x001f0000ff0000ff;
    v = (v | v << 8) & 0x100f00f00f00f00f;
    v = (v | v << 4) & 0x10c30c30c30c30c3;
    return (v | v << 2) & 0x1249249249249249;
}

/// Every third bit, from the lowest on: undoes spread_bits.
inline std::uint32_t gather_bits(std::uint64_t v) {
    v &= 0x1249249249249249;
    v = (v | v >> 2) & 0x10c30c30c30c30c3;
    v = (v | v >> 4) & 0x100f00f00f00f00f;
    v = (v | v >> 8) & 0x001f0000ff0000ff;
    v = (v | v >> 16) & 0x001f00000000ffff;
    return static_cast<std::uint32_t>((v | v >> 32) & 0x1fffff);
}

/// The code of a cell: x's bits above y's above z's. Coordinates below 2^21.
inline std::uint64_t morton_code(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    return spread_bits(x) << 2 | spread_bits(y) << 1 | spread_bits(z);
}

/// Lays a grid of 2^bits cells a side over a box. Its cells are cubes: a flat scene gets a flat grid, and no
/// bits are spent on slicing it into layers.
class MortonGrid {
  public:
    /// box: around all points that will be asked for. bits: 1 ... 21.
    MortonGrid(const Bounds3& box, int bits) : lo_(box.lo), last_((1u << bits) - 1) {
        double side = 0;
        for (int axis = 0; axis < 3; ++axis)
            side = std::max(side, static_cast<double>(box.hi[axis]) - static_cast<double>(box.lo[axis]));
        if (side > 0) scale_ = static_cast<double>(1u << bits) / side;
    }
    std::uint64_t code(Vec3 p) const { return morton_code(cell(p, 0), cell(p, 1), cell(p, 2)); }
    /// The coordinate at which a code's cell begins.
    float lower_side(std::uint64_t code, int axis) const {
        const std::uint32_t cell = gather_bits(code >> (2 - axis));
        return static_cast<float>(static_cast<double>(lo_[axis]) + (scale_ > 0 ? cell / scale_ : 0));
    }

  private:
    // In double, in which no difference of floats overflows.
    std::uint32_t cell(Vec3 p, int axis) const {
        double place = (static_cast<double>(p[axis]) - static_cast<double>(lo_[axis])) * scale_;
        return std::min(static_cast<std::uint32_t>(place), last_);
    }

    Vec3 lo_;
    std::uint32_t last_;
    double scale_ = 0;
};

/// A code and whose it is.
struct MortonKey {
    std::uint64_t code;
    std::uint32_t index;
    bool operator==(const MortonKey&) const = default;
};

/// Keys for the centroids of all boxes that are not empty, in the boxes' order.
class MortonCoder {
  public:
    /// bits for each axis: 1 ... 21. The boxes must outlive the coder.
    MortonCoder(std::span<const Bounds3> boxes, int bits = 21);

    /// How many boxes are not empty.
    std::size_t count() const { return count_; }
    /// The grid over all centroids.
    const MortonGrid& grid() const { return grid_; }
    /// Writes count() keys.
    void write(std::span<MortonKey> keys) const;

  private:
    std::span<const Bounds3> boxes_;
    std::vector<std::size_t> places_; // of the first key of each run of boxes
    std::size_t count_ = 0;
    MortonGrid grid_;
};
std::vector<MortonKey> morton_keys(std::span<const Bounds3> boxes, int bits = 21);

/// Sorts by code, in parallel; keys of the same code keep their order (so their indices rise, if they did
/// before). scratch: as many keys, of any value.
///
/// A radix sort from the highest bits down: a digit's worth of them deals the keys out to piles, until piles
/// fit the cache and are finished there. So only the first deal or two go through memory, and bits that tell
/// nothing apart are skipped; going through all 63 bits from the lowest up takes eight rounds through memory.
void sort_by_code(std::span<MortonKey> keys, std::span<MortonKey> scratch);
void sort_by_code(std::vector<MortonKey>& keys);

} // namespace alhazen
