/// The test of a node's eight boxes.
#pragma once

#include "accel/wide/kernel_ray.h"

namespace {

using F = Lanes::F;

struct Interval {
    F entry, exit;
};

/// What box tests need of a ray, read anew for each node.
struct InMemory {
    const WideSlot& slot;

    ALHAZEN_INLINE std::size_t near_plane(std::size_t axis) const { return slot.near_plane[axis]; }
    ALHAZEN_INLINE F enter(std::size_t axis, F planes) const {
        return Lanes::scale(planes, Lanes::all(slot.enter_scale[axis]), Lanes::all(slot.enter_offset[axis]));
    }
    ALHAZEN_INLINE F leave(std::size_t axis, F planes) const {
        return Lanes::scale(planes, Lanes::all(slot.leave_scale[axis]), Lanes::all(slot.leave_offset[axis]));
    }
    ALHAZEN_INLINE F tmax() const { return Lanes::all(slot.tmax); }
};

/// The same, kept in registers.
class InRegisters {
  public:
    ALHAZEN_INLINE explicit InRegisters(const WideSlot& slot) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            near_plane_[axis] = slot.near_plane[axis];
            enter_scale_[axis] = Lanes::all(slot.enter_scale[axis]);
            enter_offset_[axis] = Lanes::all(slot.enter_offset[axis]);
            leave_scale_[axis] = Lanes::all(slot.leave_scale[axis]);
            leave_offset_[axis] = Lanes::all(slot.leave_offset[axis]);
        }
        set_tmax(slot.tmax);
    }
    ALHAZEN_INLINE void set_tmax(float tmax) { tmax_ = Lanes::all(tmax); }

    ALHAZEN_INLINE std::size_t near_plane(std::size_t axis) const { return near_plane_[axis]; }
    ALHAZEN_INLINE F enter(std::size_t axis, F planes) const {
        return Lanes::scale(planes, enter_scale_[axis], enter_offset_[axis]);
    }
    ALHAZEN_INLINE F leave(std::size_t axis, F planes) const {
        return Lanes::scale(planes, leave_scale_[axis], leave_offset_[axis]);
    }
    ALHAZEN_INLINE F tmax() const { return tmax_; }

  private:
    std::size_t near_plane_[3];
    F enter_scale_[3], enter_offset_[3], leave_scale_[3], leave_offset_[3], tmax_;
};

/// Where the ray enters and leaves the boxes of the node's children.
template <class Ray>
ALHAZEN_INLINE Interval test_boxes(const Ray& ray, const char* node) {
    auto enter = [&](std::size_t axis) __attribute__((always_inline)) {
        return ray.enter(axis, Lanes::load(reinterpret_cast<const float*>(node + ray.near_plane(axis))));
    };
    auto leave = [&](std::size_t axis) __attribute__((always_inline)) {
        return ray.leave(axis,
                         Lanes::load(reinterpret_cast<const float*>(node + (ray.near_plane(axis) ^ 32))));
    };
    return {Lanes::max(Lanes::max(enter(0), enter(1)), Lanes::max(enter(2), Lanes::all(0))),
            Lanes::min(Lanes::min(leave(0), leave(1)), Lanes::min(leave(2), ray.tmax()))};
}

/// The order in which the ray meets the node's children: 8 numbers of 3 bits, the farthest first.
ALHAZEN_INLINE std::uint32_t order_of(const WideSlot& slot, const char* node) {
    std::uint32_t order;
    __builtin_memcpy(&order, node + slot.order, sizeof order);
    return order;
}

} // namespace
