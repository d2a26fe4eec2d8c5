#include "accel/build/morton.h"

#include <algorithm>
#include <array>

#include "base/threads.h"

namespace alhazen {

namespace {

constexpr std::size_t box_grain = 16384;
constexpr std::size_t sort_grain = 65536;
constexpr int digit_bits = 8;

using Histogram = std::array<std::size_t, 1 << digit_bits>;

std::size_t digit(const MortonKey& key, int shift) {
    return static_cast<std::size_t>(key.code >> shift) & ((1 << digit_bits) - 1);
}

// Turns the runs' counts of each digit into the places where each run puts its keys of that digit. False if
// all keys share one digit: then they are in order already.
bool counts_to_places(std::vector<Histogram>& runs, std::size_t keys) {
    std::size_t place = 0;
    for (std::size_t d = 0; d < Histogram{}.size(); ++d) {
        std::size_t before = place;
        for (Histogram& run : runs) {
            std::size_t count = run[d];
            run[d] = place;
            place += count;
        }
        if (place - before == keys) return false;
    }
    return true;
}

} // namespace

std::vector<MortonKey> morton_keys(std::span<const Bounds3> boxes, int bits) {
    struct Part {
        Bounds3 centroids;
        std::size_t count = 0;
    };
    std::vector<Part> parts((boxes.size() + box_grain - 1) / box_grain);
    parallel_ranges(boxes.size(), box_grain, [&](std::size_t begin, std::size_t end) {
        Part part;
        for (const Bounds3& box : boxes.subspan(begin, end - begin)) {
            if (box.empty()) continue;
            part.centroids.extend(box.centroid());
            ++part.count;
        }
        parts[begin / box_grain] = part;
    });
    Bounds3 centroids;
    std::size_t count = 0;
    for (Part& part : parts) {
        centroids.extend(part.centroids);
        std::size_t before = count;
        count += part.count;
        part.count = before; // from here on: the run's first place
    }
    MortonGrid grid(centroids, bits);
    std::vector<MortonKey> keys(count);
    parallel_ranges(boxes.size(), box_grain, [&](std::size_t begin, std::size_t end) {
        std::size_t place = parts[begin / box_grain].count;
        for (std::size_t i = begin; i < end; ++i)
            if (!boxes[i].empty())
                keys[place++] = {grid.code(boxes[i].centroid()), static_cast<std::uint32_t>(i)};
    });
    return keys;
}

void sort_by_code(std::vector<MortonKey>& keys) {
    std::vector<MortonKey> sorted(keys.size());
    std::vector<Histogram> runs((keys.size() + sort_grain - 1) / sort_grain);
    for (int shift = 0; shift < 64; shift += digit_bits) {
        parallel_ranges(keys.size(), sort_grain, [&](std::size_t begin, std::size_t end) {
            Histogram& run = runs[begin / sort_grain];
            run.fill(0);
            for (std::size_t i = begin; i < end; ++i) ++run[digit(keys[i], shift)];
        });
        if (!counts_to_places(runs, keys.size())) continue;
        parallel_ranges(keys.size(), sort_grain, [&](std::size_t begin, std::size_t end) {
            Histogram& run = runs[begin / sort_grain];
            for (std::size_t i = begin; i < end; ++i) sorted[run[digit(keys[i], shift)]++] = keys[i];
        });
        keys.swap(sorted);
    }
}

} // namespace alhazen
