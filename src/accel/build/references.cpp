#include "accel/build/references.h"

#include <vector>

#include "base/threads.h"

namespace alhazen {

namespace {

constexpr std::size_t grain = 16384;

} // namespace

ReferenceList make_references(std::span<const Bounds3> boxes, float extra) {
    // Where each run's references begin.
    std::vector<std::size_t> begin((boxes.size() + grain - 1) / grain + 1, 0);
    parallel_ranges(boxes.size(), grain, [&](std::size_t first, std::size_t end) {
        std::size_t n = 0;
        for (std::size_t i = first; i < end; ++i) n += !boxes[i].empty();
        begin[first / grain + 1] = n;
    });
    for (std::size_t run = 1; run < begin.size(); ++run) begin[run] += begin[run - 1];

    ReferenceList list;
    list.count = begin.back();
    auto spare = static_cast<std::size_t>(static_cast<double>(extra) * static_cast<double>(list.count));
    list.references = BigArray<Reference>(list.count + spare);
    auto add = [&](Extent& extent, std::size_t first, std::size_t end) {
        std::size_t place = begin[first / grain];
        for (std::size_t i = first; i < end; ++i) {
            if (boxes[i].empty()) continue;
            Reference r = make_reference(boxes[i], static_cast<std::uint32_t>(i));
            extent.add(r);
            list.references[place++] = r;
        }
    };
    list.extent = parallel_sum(boxes.size(), grain, Extent{}, add,
                               [](Extent& sum, const Extent& part) { sum.join(part); });
    return list;
}

} // namespace alhazen
