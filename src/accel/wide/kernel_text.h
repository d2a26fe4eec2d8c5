/// The kernels of the production structure, once for every instruction set: a file that includes this has
/// defined Lanes before (eight floats).
///
/// A ray waits most of its time: for memory, and for mispredicted branches. So a thread keeps many rays in
/// flight. They take turns: a ray advances by one node, says which memory it needs next, and goes to the back
/// of the ring; until it is its turn again the memory has arrived. The step through a node has no branch: the
/// children that are hit are compressed onto the ray's own stack, and the top is taken off again, with a
/// sentinel at the bottom. Rays that have come to a leaf wait in a list, and are served together when few are
/// left in the ring. (The idea of hiding latency with several rays a thread: Guthe 2014; sorting children by
/// octant: Ylitie, Karras and Laine 2017; the schedule is our own.)
#pragma once

#include "accel/wide/kernel_leaf.h"

namespace {

enum : std::uint32_t {
    rays_in_flight = 16,
    rays_left = 4,      // on the way through nodes, when leaves are served
    ring_size = 64,     // a power of two above all rays in flight
    prefetched = 4 * 64 // bytes of a node, or of the beginning of a leaf
};

struct Interval {
    F entry, exit;
};

/// Where the ray enters and leaves the boxes of the node's children.
ALHAZEN_INLINE Interval test_boxes(const WideSlot& slot, const char* node) {
    auto planes = [&](std::size_t axis, std::uint32_t other) {
        return Lanes::load(reinterpret_cast<const float*>(node + (slot.near_plane[axis] ^ other)));
    };
    auto enter = [&](std::size_t axis) {
        return Lanes::scale(planes(axis, 0), Lanes::all(slot.enter_scale[axis]),
                            Lanes::all(slot.enter_offset[axis]));
    };
    auto leave = [&](std::size_t axis) {
        return Lanes::scale(planes(axis, 32), Lanes::all(slot.leave_scale[axis]),
                            Lanes::all(slot.leave_offset[axis]));
    };
    return {Lanes::max(Lanes::max(enter(0), enter(1)), Lanes::max(enter(2), Lanes::all(0))),
            Lanes::min(Lanes::min(leave(0), leave(1)), Lanes::min(leave(2), Lanes::all(slot.tmax)))};
}

ALHAZEN_INLINE std::uint32_t order_of(const WideSlot& slot, const char* node) {
    std::uint32_t order;
    __builtin_memcpy(&order, node + slot.order, sizeof order);
    return order;
}

/// Visits a node: pushes the children that are hit, the nearest last, and takes the last off again.
template <bool any>
ALHAZEN_INLINE std::uint32_t step(WideSlot& slot, const char* at) {
    const auto* node = reinterpret_cast<const WideNode*>(at);
    const Interval t = test_boxes(slot, at);
    std::uint32_t height = slot.height;
    if constexpr (any)
        height += Lanes::push(t.entry, t.exit, node->child, slot.reference + height);
    else
        height += Lanes::push_in_order(t.entry, t.exit, node->child, order_of(slot, at), slot.is_reversed,
                                       slot.reference + height, slot.entry + height);
    slot.height = --height;
    return slot.reference[height];
}

ALHAZEN_INLINE void prefetch(const char* p) {
    for (std::size_t line = 0; line < prefetched; line += 64) Lanes::prefetch(p + line);
}

/// The rays in flight: those on their way through nodes, in the order of their turns, and those at a leaf.
struct Flight {
    WideSlot* moving[ring_size];
    WideSlot* at_leaf[rays_in_flight + 1];
    std::uint32_t first = 0, last = 0; ///< of those that move
    std::uint32_t leaves = 0;

    /// Without a branch, since where a ray comes to cannot be foreseen.
    ALHAZEN_INLINE void route(WideSlot& slot, const char* base, std::uint32_t reference) {
        slot.next = reference;
        prefetch(base + reference);
        const std::uint32_t is_leaf = reference & alhazen::wide_leaf;
        moving[last % ring_size] = &slot;
        at_leaf[leaves] = &slot;
        last += 1 - is_leaf;
        leaves += is_leaf;
    }
};

template <bool any>
void trace_interleaved(const WideQuery& query) {
    WideSlot slots[rays_in_flight];
    Flight flight;
    const char* const base = query.base;
    const std::uint32_t count = query.count;
    std::uint32_t next_ray = 0;
    auto admit = [&](WideSlot & slot) __attribute__((always_inline)) {
        while (next_ray < count) {
            if (begin(query, slot, next_ray++)) return flight.route(slot, base, query.root);
        }
    };
    for (WideSlot& slot : slots) admit(slot);
    for (;;) {
        while (flight.last - flight.first > rays_left ||
               (flight.leaves == 0 && flight.last != flight.first)) {
            WideSlot& slot = *flight.moving[flight.first++ % ring_size];
            flight.route(slot, base, step<any>(slot, base + slot.next));
        }
        const std::uint32_t leaves = flight.leaves;
        if (leaves == 0) return;
        flight.leaves = 0;
        for (std::uint32_t i = 0; i < leaves; ++i) {
            WideSlot& slot = *flight.at_leaf[i];
            const std::uint32_t leaf = slot.next;
            if (leaf != alhazen::wide_done) [[likely]] {
                if (!visit_leaf<any>(query, base, slot, leaf)) {
                    flight.route(slot, base, slot.reference[--slot.height]);
                    continue;
                }
                if constexpr (!any) {
                    slot.height = Lanes::drop_beyond(slot.tmax, slot.height, slot.reference, slot.entry);
                    flight.route(slot, base, slot.reference[--slot.height]);
                    continue;
                }
                query.blocked[slot.ray] = 1;
            }
            finish<any>(query, slot);
            admit(slot);
        }
    }
}

/// From a node down to the next leaf, or to the end. Here branches pay: most rays hit no child or one.
template <bool any, bool counted>
ALHAZEN_INLINE std::uint32_t descend(const char* base, WideSlot& slot, std::uint32_t reference) {
    while (!(reference & alhazen::wide_leaf)) {
        const char* at = base + reference;
        const auto* node = reinterpret_cast<const WideNode*>(at);
        if (counted) ++slot.nodes;
        const Interval t = test_boxes(slot, at);
        const std::uint32_t hits = Lanes::at_most(t.entry, t.exit);
        if (hits == 0) {
            reference = slot.reference[--slot.height];
            continue;
        }
        const std::uint32_t more = hits & (hits - 1);
        const auto one = static_cast<std::uint32_t>(__builtin_ctz(hits));
        if (more == 0) {
            reference = node->child[one];
            continue;
        }
        if (!any && (more & (more - 1)) == 0) {
            const auto two = static_cast<std::uint32_t>(__builtin_ctz(more));
            const float t1 = Lanes::lane(t.entry, one), t2 = Lanes::lane(t.entry, two);
            const std::uint32_t c1 = node->child[one], c2 = node->child[two];
            const bool swapped = t2 < t1;
            slot.reference[slot.height] = swapped ? c1 : c2;
            slot.entry[slot.height++] = swapped ? t1 : t2;
            reference = swapped ? c2 : c1;
            continue;
        }
        if constexpr (any)
            slot.height += Lanes::push(t.entry, t.exit, node->child, slot.reference + slot.height);
        else
            slot.height +=
                Lanes::push_in_order(t.entry, t.exit, node->child, order_of(slot, at), slot.is_reversed,
                                     slot.reference + slot.height, slot.entry + slot.height);
        if (counted && slot.height > slot.highest) slot.highest = slot.height;
        reference = slot.reference[--slot.height];
    }
    return reference;
}

template <bool any, bool counted>
void trace_in_turn(const WideQuery& query) {
    WideSlot slot;
    for (std::uint32_t ray = 0; ray < query.count; ++ray) {
        if (!begin(query, slot, ray)) continue;
        if (counted) slot.nodes = slot.leaves = slot.highest = 0;
        std::uint32_t reference = query.root;
        for (;;) {
            reference = descend<any, counted>(query.base, slot, reference);
            if (reference == alhazen::wide_done) break;
            if (counted) ++slot.leaves;
            if (visit_leaf<any>(query, query.base, slot, reference)) {
                if (any) {
                    query.blocked[slot.ray] = 1;
                    break;
                }
                slot.height = Lanes::drop_beyond(slot.tmax, slot.height, slot.reference, slot.entry);
            }
            reference = slot.reference[--slot.height];
        }
        finish<any>(query, slot);
        if (counted) query.count_visits(query.owner, slot);
    }
}

constexpr alhazen::WideKernels make_kernels(const char* name, bool (*is_supported)()) {
    return {name,
            is_supported,
            trace_interleaved<false>,
            trace_interleaved<true>,
            trace_in_turn<false, false>,
            trace_in_turn<true, false>,
            trace_in_turn<false, true>,
            trace_in_turn<true, true>};
}

} // namespace
