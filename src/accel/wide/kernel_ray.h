/// How a ray is prepared for its way through nodes and leaves: BoxRay and RayShear, in four lanes.
#pragma once

#include "accel/wide/four_lanes.h"

namespace {

using alhazen::WideNode;
using alhazen::WideQuery;
using alhazen::WideRay;
using alhazen::WideSlot;
using alhazen::WideStack;

constexpr std::uint32_t no_hit = 0xffffffffu;
constexpr float largest_float = 0x1.fffffep127f;

/// Where an octant's order stands in a node, and whether it is read from its end. Orders are for octants that
/// go forwards in x. Octants: bit 0 for backwards in x, bit 1 in y, bit 2 in z.
struct OctantOrder {
    std::uint32_t offset, is_reversed;
};
constexpr OctantOrder order_of_octant(std::uint32_t octant) {
    const std::uint32_t x = octant & 1, y = octant >> 1 & 1, z = octant >> 2;
    return {static_cast<std::uint32_t>(offsetof(WideNode, order)) + 3 * ((x ^ y) + 2 * (x ^ z)), x};
}
constexpr OctantOrder octant_orders[8] = {order_of_octant(0), order_of_octant(1), order_of_octant(2),
                                          order_of_octant(3), order_of_octant(4), order_of_octant(5),
                                          order_of_octant(6), order_of_octant(7)};

/// The longest axis, by which of x > y, y > z, x > z hold (bits 0, 1, 2).
constexpr std::uint8_t longest_axis[8] = {2, 2, 1, 2, 2, 0, 1, 0};

/// What RayShear holds, by the same operations; and the origin in the sheared axes.
ALHAZEN_INLINE void set_shear(WideSlot& slot, F4 o, F4 d, F4 speed) {
    const F4 left = __builtin_shufflevector(speed, speed, 0, 1, 0, 3),
             right = __builtin_shufflevector(speed, speed, 1, 2, 2, 3);
    const ShearOrder& order = shear_orders[longest_axis[signs_of(left > right) & 7]];
    const F4 along = in_order(d, order);
    const F4 length = __builtin_shufflevector(along, along, 2, 2, 2, 2);
    const F4 ones = {1, 1, 1, 1};
    store_four(slot.shear, __builtin_shufflevector(along, ones, 0, 1, 4, 5) / length);
    store_four(slot.origin, in_order(o, order));
    __builtin_memcpy(slot.axis, order.axis, sizeof slot.axis);
}

/// What BoxRay holds; see there. The reach is taken from all axes, for simplicity.
ALHAZEN_INLINE void set_scales(WideSlot& slot, F4 o, F4 d, F4 speed, float extent) {
    constexpr float unit = 0x1p-24f;
    const I4 sign = bits_of(d) & static_cast<int>(0x80000000u);
    const F4 size = reinterpret_cast<F4>(bits_of(o) & 0x7fffffff);
    const float longest = largest_of(speed), farthest = largest_of(size);
    const F4 spread = F4{} + 16 * unit * longest;
    const F4 steady_pad = F4{} + 32 * unit * (farthest + extent);
    const F4 pad = 4 * unit * size + (speed < 4 * spread ? steady_pad : F4{});
    const F4 slow = speed - spread;
    const F4 backward = with_sign(pad, sign);
    F4 enter = with_sign(1 / (speed + spread), sign);
    F4 leave = with_sign(1 / (slow > spread ? slow : spread), sign);
    F4 leave_offset = (o - backward) * leave;
    const float largest = farthest > extent ? farthest : extent;
    // Here products overflow: all boxes are visited. No scene has such rays.
    if (!((longest > 0x1p-60f) & (longest < 0x1p+60f) & (largest < 0x1p+60f))) [[unlikely]] {
        enter = leave = F4{};
        leave_offset = F4{} - largest_float;
    }
    store_four(slot.enter_scale, enter);
    store_four(slot.leave_scale, leave);
    store_four(slot.enter_offset, (o + backward) * enter);
    store_four(slot.leave_offset, leave_offset);
    store_four(slot.near_plane, ((sign >> 31) & 32) + I4{0, 64, 128, 0});
    const OctantOrder order = octant_orders[signs_of(sign) & 7];
    slot.order = order.offset;
    slot.is_reversed = order.is_reversed;
}

/// Prepares the slot for a ray; false when the ray can hit nothing (see is_traceable).
ALHAZEN_INLINE bool begin(const WideQuery& query, WideSlot& slot, std::uint32_t number) {
    const WideRay& ray = query.rays[number];
    static_assert(offsetof(WideRay, d) == 12 && offsetof(WideRay, tmax) == 24);
    // Fourth lanes: the direction's x, and tmax.
    const F4 o = load_four(ray.o), d = load_four(ray.d);
    const std::uint32_t is_infinite = signs_of(((o - o) != 0) | ((d - d) != 0)) & 7;
    const std::uint32_t is_still = (signs_of(d == 0) & 7) == 7;
    if (is_infinite | is_still | !(ray.tmax > 0)) [[unlikely]]
        return false;
    const F4 speed = reinterpret_cast<F4>(bits_of(d) & 0x7fffffff);
    set_scales(slot, o, d, speed, query.extent);
    set_shear(slot, o, d, speed);
    slot.tmax = ray.tmax;
    slot.ray = number;
    slot.t = __builtin_inff();
    slot.primitive = no_hit;
    slot.height = 1;
    slot.next = query.root;
    return true;
}

/// What is below everything on a stack.
ALHAZEN_INLINE void put_sentinel(WideStack& stack) {
    stack.reference[0] = alhazen::wide_done;
    stack.entry[0] = -__builtin_inff();
}

template <bool any>
ALHAZEN_INLINE void finish(const WideQuery& query, const WideSlot& slot) {
    if constexpr (!any)
        if (slot.primitive != no_hit) query.hits[slot.ray] = {slot.t, slot.u, slot.v, slot.primitive, 0};
}

} // namespace
