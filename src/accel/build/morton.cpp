#include "accel/build/morton.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "base/threads.h"

namespace alhazen {

namespace {

constexpr std::size_t box_grain = 16384;

// What is smaller than this is sorted by one thread, and what is smaller than that by insertion.
constexpr std::size_t parallel_size = std::size_t{1} << 16;
constexpr std::size_t insertion_size = 24;
constexpr int parallel_digit = 9, most_digit = 8;

// Which bits to deal by: the highest that differ.
struct Digit {
    int shift;
    std::uint64_t mask;

    Digit(std::uint64_t differing, int width)
        : shift(std::max(0, static_cast<int>(std::bit_width(differing)) - width)),
          mask((std::uint64_t{1} << width) - 1) {}
    std::size_t operator()(const MortonKey& key) const { return key.code >> shift & mask; }
};

std::uint64_t differing_bits(std::span<const MortonKey> keys, std::uint64_t code) {
    std::uint64_t bits = 0;
    for (const MortonKey& key : keys) bits |= key.code ^ code;
    return bits;
}

void insertion_sort(std::span<const MortonKey> keys, MortonKey* sorted) {
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const MortonKey key = keys[i];
        std::size_t place = i;
        for (; place > 0 && sorted[place - 1].code > key.code; --place) sorted[place] = sorted[place - 1];
        sorted[place] = key;
    }
}

// The keys are dealt from one array to the other and back; the result is to be in other or in keys.
void sort_run(std::span<MortonKey> keys, MortonKey* other, bool into_other) {
    if (keys.size() <= insertion_size) {
        insertion_sort(keys, into_other ? other : keys.data());
        return;
    }
    const std::uint64_t differing = differing_bits(keys, keys[0].code);
    if (differing == 0) {
        if (into_other) std::copy(keys.begin(), keys.end(), other);
        return;
    }
    const int width = std::min(static_cast<int>(std::bit_width(keys.size())) - 2, most_digit);
    const Digit digit(differing, width);
    std::array<std::uint32_t, 1 << most_digit> ends{};
    for (const MortonKey& key : keys) ++ends[digit(key)];
    std::uint32_t place = 0;
    for (std::size_t d = 0; d <= digit.mask; ++d) place += std::exchange(ends[d], place);
    for (const MortonKey& key : keys) other[ends[digit(key)]++] = key;
    std::uint32_t begin = 0;
    for (std::size_t d = 0; d <= digit.mask; begin = ends[d], ++d)
        if (ends[d] > begin) sort_run({other + begin, ends[d] - begin}, keys.data() + begin, !into_other);
}

using Histogram = std::array<std::uint32_t, 1 << parallel_digit>;

// Turns the runs' counts of each digit into the places where each run puts its keys of that digit, and
// returns where the digits' piles end.
Histogram counts_to_places(std::vector<Histogram>& runs) {
    Histogram ends{};
    std::uint32_t place = 0;
    for (std::size_t d = 0; d < ends.size(); ++d) {
        for (Histogram& run : runs) place += std::exchange(run[d], place);
        ends[d] = place;
    }
    return ends;
}

void sort_parallel(std::span<MortonKey> keys, MortonKey* other, bool into_other) {
    if (keys.size() < parallel_size) return sort_run(keys, other, into_other);
    const std::size_t grain = std::max(parallel_size / 4, keys.size() / 64);
    const std::uint64_t differing = parallel_sum(
        keys.size(), grain, std::uint64_t{0},
        [&](std::uint64_t& sum, std::size_t begin, std::size_t end) {
            sum |= differing_bits(keys.subspan(begin, end - begin), keys[0].code);
        },
        [](std::uint64_t& sum, std::uint64_t part) { sum |= part; });
    const Digit digit(differing, parallel_digit);
    std::vector<Histogram> runs((keys.size() + grain - 1) / grain);
    parallel_ranges(keys.size(), grain, [&](std::size_t begin, std::size_t end) {
        Histogram counts{};
        for (const MortonKey& key : keys.subspan(begin, end - begin)) ++counts[digit(key)];
        runs[begin / grain] = counts;
    });
    const Histogram ends = counts_to_places(runs);
    parallel_ranges(keys.size(), grain, [&](std::size_t begin, std::size_t end) {
        Histogram places = runs[begin / grain];
        for (const MortonKey& key : keys.subspan(begin, end - begin)) other[places[digit(key)]++] = key;
    });
    parallel_for(ends.size(), 1, [&](std::size_t d) {
        const std::uint32_t begin = d ? ends[d - 1] : 0, count = ends[d] - begin;
        if (count == 0) return;
        std::span<MortonKey> pile(other + begin, count);
        // All keys in one pile: their codes are the same.
        if (differing == 0) {
            if (!into_other) std::copy(pile.begin(), pile.end(), keys.begin());
        } else {
            sort_parallel(pile, keys.data() + begin, !into_other);
        }
    });
}

} // namespace

MortonCoder::MortonCoder(std::span<const Bounds3> boxes, int bits)
    : boxes_(boxes), places_((boxes.size() + box_grain - 1) / box_grain), grid_({}, bits) {
    std::vector<Bounds3> parts(places_.size());
    parallel_ranges(boxes.size(), box_grain, [&](std::size_t begin, std::size_t end) {
        Bounds3 centroids;
        std::size_t count = 0;
        for (const Bounds3& box : boxes.subspan(begin, end - begin)) {
            if (box.empty()) continue;
            centroids.extend(box.centroid());
            ++count;
        }
        parts[begin / box_grain] = centroids;
        places_[begin / box_grain] = count;
    });
    Bounds3 centroids;
    for (const Bounds3& part : parts) centroids.extend(part);
    for (std::size_t& place : places_) count_ += std::exchange(place, count_);
    grid_ = MortonGrid(centroids, bits);
}

void MortonCoder::write(std::span<MortonKey> keys) const {
    parallel_ranges(boxes_.size(), box_grain, [&](std::size_t begin, std::size_t end) {
        MortonKey* key = keys.data() + places_[begin / box_grain];
        for (std::size_t i = begin; i < end; ++i)
            if (!boxes_[i].empty())
                *key++ = {grid_.code(boxes_[i].centroid()), static_cast<std::uint32_t>(i)};
    });
}

std::vector<MortonKey> morton_keys(std::span<const Bounds3> boxes, int bits) {
    MortonCoder coder(boxes, bits);
    std::vector<MortonKey> keys(coder.count());
    coder.write(keys);
    return keys;
}

void sort_by_code(std::span<MortonKey> keys, std::span<MortonKey> scratch) {
    sort_parallel(keys, scratch.data(), false);
}

void sort_by_code(std::vector<MortonKey>& keys) {
    std::vector<MortonKey> scratch(keys.size());
    sort_by_code(keys, scratch);
}

} // namespace alhazen
