/// Many rays in turn.
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

struct RayInFlight {
    WideSlot slot;
    WideStack stack;
};

/// Visits a node: pushes the children that are hit, the nearest last, and takes the last off again.
template <bool any>
ALHAZEN_INLINE std::uint32_t step(RayInFlight& ray, const char* at) {
    WideSlot& slot = ray.slot;
    WideStack& stack = ray.stack;
    const auto* node = reinterpret_cast<const WideNode*>(at);
    const Interval t = test_boxes(InMemory{slot}, at);
    std::uint32_t height = slot.height;
    if constexpr (any)
        height += Lanes::push(t.entry, t.exit, node->child, stack.reference + height);
    else
        height += Lanes::push_in_order(t.entry, t.exit, node->child, order_of(slot, at), slot.is_reversed,
                                       stack.reference + height, stack.entry + height);
    slot.height = --height;
    return stack.reference[height];
}

ALHAZEN_INLINE void prefetch(const char* p) {
    for (std::size_t line = 0; line < prefetched; line += 64) Lanes::prefetch(p + line);
}

/// The rays in flight: those on their way through nodes, in the order of their turns, and those at a leaf.
struct Flight {
    RayInFlight* moving[ring_size];
    RayInFlight* at_leaf[rays_in_flight + 1];
    std::uint32_t first = 0, last = 0; ///< of those that move
    std::uint32_t leaves = 0;

    /// Without a branch, since where a ray comes to cannot be foreseen.
    ALHAZEN_INLINE void route(RayInFlight& ray, const char* base, std::uint32_t reference) {
        ray.slot.next = reference;
        prefetch(base + reference);
        const std::uint32_t is_leaf = reference & alhazen::wide_leaf;
        moving[last % ring_size] = &ray;
        at_leaf[leaves] = &ray;
        last += 1 - is_leaf;
        leaves += is_leaf;
    }
};

template <bool any>
void trace_interleaved(const WideQuery& query, std::uint32_t next_ray, std::uint32_t end) {
    RayInFlight rays[rays_in_flight];
    Flight flight;
    const char* const base = query.base;
    auto admit = [&](RayInFlight & ray) __attribute__((always_inline)) {
        while (next_ray < end) {
            if (begin(query, ray.slot, next_ray++)) return flight.route(ray, base, query.root);
        }
    };
    for (RayInFlight& ray : rays) {
        put_sentinel(ray.stack);
        admit(ray);
    }
    for (;;) {
        while (flight.last - flight.first > rays_left ||
               (flight.leaves == 0 && flight.last != flight.first)) {
            RayInFlight& ray = *flight.moving[flight.first++ % ring_size];
            flight.route(ray, base, step<any>(ray, base + ray.slot.next));
        }
        const std::uint32_t leaves = flight.leaves;
        if (leaves == 0) return;
        flight.leaves = 0;
        for (std::uint32_t i = 0; i < leaves; ++i) {
            RayInFlight& ray = *flight.at_leaf[i];
            WideSlot& slot = ray.slot;
            const std::uint32_t leaf = slot.next;
            if (leaf != alhazen::wide_done) [[likely]] {
                const bool has_changed = visit_leaf<any>(query, base, slot, leaf);
                if (!any || !has_changed) {
                    if (has_changed)
                        slot.height =
                            Lanes::drop_beyond(slot.tmax, slot.height, ray.stack.reference, ray.stack.entry);
                    flight.route(ray, base, ray.stack.reference[--slot.height]);
                    continue;
                }
                query.blocked[slot.ray] = 1;
            }
            finish<any>(query, slot);
            admit(ray);
        }
    }
}

} // namespace
