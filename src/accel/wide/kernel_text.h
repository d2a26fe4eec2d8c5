/// The kernels of the production structure, once for every instruction set: a file that includes this has
/// defined Lanes before (eight floats). Batches are traced with many rays in turn, but for runs of rays that
/// go nearly the same way, which are traced as packets; single rays by themselves.
#pragma once

#include "accel/wide/kernel_interleaved.h"
#include "accel/wide/kernel_packet.h"
#include "accel/wide/kernel_single.h"

namespace {

template <bool any, bool counted>
void trace_in_turn(const WideQuery& query) {
    WideSlot slot;
    WideStack stack;
    for (std::uint32_t ray = 0; ray < query.count; ++ray) {
        if (!begin(query, slot, ray)) continue;
        if (counted) slot.nodes = slot.leaves = slot.highest = 0;
        SingleWalk<any, counted>(query, slot, stack).run(query.root);
        finish<any>(query, slot);
        if (counted) query.count_visits(query.owner, slot);
    }
}

void closest(const WideQuery& query) {
    std::uint32_t first = 0; // of those that wait to be traced interleaved
    for (std::uint32_t begin = 0; begin < query.count; begin += packet_size) {
        const std::uint32_t n =
            query.count - begin < packet_size ? query.count - begin : std::uint32_t{packet_size};
        if (!look_coherent(query.rays + begin, n)) continue;
        if (first < begin) trace_interleaved<false>(query, first, begin);
        first = begin;
        if (trace_packet(query, begin, n)) first = begin + n;
    }
    if (first < query.count) trace_interleaved<false>(query, first, query.count);
}

void any(const WideQuery& query) {
    trace_interleaved<true>(query, 0, query.count);
}

constexpr alhazen::WideKernels make_kernels(const char* name, bool (*is_supported)()) {
    return {name,
            is_supported,
            closest,
            any,
            trace_in_turn<false, false>,
            trace_in_turn<true, false>,
            trace_in_turn<false, true>,
            trace_in_turn<true, true>};
}

} // namespace
