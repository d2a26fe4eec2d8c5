/// What builders by the surface area heuristic move about: a box with the number of its primitive, two
/// registers wide.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include "base/big_array.h"
#include "base/bounds.h"
#include "base/lanes.h"

namespace alhazen {

/// {m, m, m, m}, m all ones or zero.
inline IntLanes4 all_int_lanes(int v) {
    return IntLanes4{v, v, v, v};
}
/// v, its lanes NaN where the mask is set: min_lanes and max_lanes pass over them.
inline Lanes4 nan_where(Lanes4 v, IntLanes4 mask) {
    return std::bit_cast<Lanes4>(std::bit_cast<IntLanes4>(v) | mask);
}

/// The box of a primitive, or of a piece of it. The primitive's number hides in lo's fourth lane, so that
/// both move as two registers; hi's fourth lane is 0.
struct Reference {
    Lanes4 lo, hi;

    std::uint32_t primitive() const { return std::bit_cast<std::uint32_t>(static_cast<float>(lo[3])); }
    /// Twice the box's centre; the fourth lane is 0. Infinite where coordinates are beyond half of the
    /// largest float.
    Lanes4 doubled_centroid() const {
        const IntLanes4 xyz{-1, -1, -1, 0};
        return std::bit_cast<Lanes4>(std::bit_cast<IntLanes4>(lo + hi) & xyz);
    }
};

inline Reference make_reference(const Bounds3& box, std::uint32_t primitive) {
    return {to_lanes(box.lo, std::bit_cast<float>(primitive)), to_lanes(box.hi)};
}

/// A box in registers that holds anything until it is set: for arrays of which only some are used. The fourth
/// lanes mean nothing.
struct RawBox {
    Lanes4 lo, hi;

    void clear() {
        lo = all_lanes(infinity);
        hi = all_lanes(-infinity);
    }
    void extend(Lanes4 l, Lanes4 h) {
        lo = min_lanes(l, lo);
        hi = max_lanes(h, hi);
    }
    void extend(const RawBox& b) { extend(b.lo, b.hi); }
    bool empty() const {
        const IntLanes4 xyz{-1, -1, -1, 0};
        auto inverted = std::bit_cast<std::array<std::uint64_t, 2>>(IntLanes4(lo > hi) & xyz);
        return (inverted[0] | inverted[1]) != 0;
    }
    /// Half of the surface area of a box that is not empty.
    float half_area() const {
        Lanes4 d = hi - lo;
        return d[0] * (d[1] + d[2]) + d[1] * d[2];
    }
    Bounds3 bounds() const { return {to_vec3(lo), to_vec3(hi)}; }
};

/// The same, empty as constructed.
struct LaneBox : RawBox {
    LaneBox() { clear(); }
    LaneBox(Lanes4 l, Lanes4 h) : RawBox{l, h} {}
};

/// The box around some references, and around their centres (doubled).
struct Extent {
    LaneBox box, centroids;

    void add(const Reference& r) {
        box.extend(r.lo, r.hi);
        Lanes4 c = r.doubled_centroid();
        centroids.extend(c, c);
    }
    void join(const Extent& other) {
        box.extend(other.box);
        centroids.extend(other.centroids);
    }
};

/// The references to all boxes that are not empty, in order, and what they extend over.
struct ReferenceList {
    BigArray<Reference> references; ///< with room behind the last
    std::size_t count = 0;
    Extent extent;
};
/// extra: how many more references there shall be room for, as a fraction of the boxes.
ReferenceList make_references(std::span<const Bounds3> boxes, float extra = 0);

} // namespace alhazen
