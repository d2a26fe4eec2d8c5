/// A ray against the boxes of a compressed node.
#pragma once

#include <cstring>

#include "accel/box_ray.h"
#include "accel/layout/compressed.h"
#include "base/lanes.h"

namespace alhazen {

class CompressedTest {
  public:
    explicit CompressedTest(const BoxRay& ray) : ray_(ray) {
        for (int axis = 0; axis < 3; ++axis)
            if (!ray.near_side[axis]) octant_ |= 1u << axis;
    }

    /// A bit an axis, set where the ray goes forwards.
    std::uint32_t octant() const { return octant_; }

    /// Slots first ... first + 3: where the ray enters their boxes, whatever tmax is, and whether it does (-1
    /// or 0). Slots without a child may seem to be hit.
    struct Four {
        Lanes4 entry;
        IntLanes4 is_hit;
    };
    Four operator()(const CompressedNode& node, int first, float tmax) const {
        Lanes4 entry = all_lanes(0), exit = all_lanes(tmax);
        for (int axis = 0; axis < 3; ++axis) {
            const int near = ray_.near_side[axis];
            const float step = node.step(axis), origin = node.origin[axis];
            const Lanes4 in = to_floats(node.planes[near][axis] + first) * step + origin;
            const Lanes4 out = to_floats(node.planes[1 - near][axis] + first) * step + origin;
            entry = max_lanes(in * ray_.enter_scale[axis] - ray_.enter_offset[axis], entry);
            exit = min_lanes(out * ray_.leave_scale[axis] - ray_.leave_offset[axis], exit);
        }
        return {entry, entry <= exit};
    }

  private:
    static Lanes4 to_floats(const std::uint8_t* from) {
        using Bytes4 = std::uint8_t __attribute__((vector_size(4)));
        Bytes4 bytes;
        std::memcpy(&bytes, from, sizeof bytes);
        return __builtin_convertvector(__builtin_convertvector(bytes, IntLanes4), Lanes4);
    }

    BoxRay ray_;
    std::uint32_t octant_ = 0;
};

} // namespace alhazen
