#include "accel/layout/path_hash.h"

#include <algorithm>

#include "base/hash.h"

namespace alhazen {

PathHash::PathHash(std::span<const Entry> entries) {
    // At most four of five places are taken, and about two keys share a displacement: fuller tables cost more
    // tries, emptier ones memory.
    const std::size_t n = std::max<std::size_t>(entries.size(), 1);
    nodes_.resize(std::bit_ceil(n + n / 4));
    displacements_.resize(std::bit_ceil((n + 1) / 2));
    // Keys of one bucket with the same home cannot be parted by moving both; then all are scrambled anew.
    // (Fewer than one such pair is expected, whatever the size of the tree.)
    for (std::uint64_t i = 0; !try_to_place(entries); ++i) seed_ = mix_bits(i + 1);
    for (const Entry& e : entries) nodes_[place(e.key)] = e.node;
}

bool PathHash::try_to_place(std::span<const Entry> entries) {
    // The keys' homes, bucket after bucket.
    std::vector<std::uint32_t> end(displacements_.size() + 1, 0);
    for (const Entry& e : entries) ++end[bucket(scramble(e.key)) + 1];
    for (std::size_t b = 1; b < end.size(); ++b) end[b] += end[b - 1];
    std::vector<std::size_t> homes(entries.size());
    std::vector<std::uint32_t> next(end.begin(), end.end() - 1);
    for (const Entry& e : entries) {
        const std::uint64_t h = scramble(e.key);
        homes[next[bucket(h)]++] = home(h) & (nodes_.size() - 1);
    }
    auto homes_of = [&](std::size_t b) { return std::span(homes).subspan(end[b], end[b + 1] - end[b]); };
    // The largest first, while there is room.
    std::vector<std::uint32_t> buckets(displacements_.size());
    for (std::size_t b = 0; b < buckets.size(); ++b) {
        buckets[b] = static_cast<std::uint32_t>(b);
        auto of_bucket = homes_of(b);
        std::sort(of_bucket.begin(), of_bucket.end());
        if (std::adjacent_find(of_bucket.begin(), of_bucket.end()) != of_bucket.end()) return false;
    }
    std::stable_sort(buckets.begin(), buckets.end(), [&](std::uint32_t a, std::uint32_t b) {
        return homes_of(a).size() > homes_of(b).size();
    });
    std::vector<bool> taken(nodes_.size(), false);
    for (std::uint32_t b : buckets)
        if (!displace(b, homes_of(b), taken)) return false;
    return true;
}

bool PathHash::displace(std::size_t bucket, std::span<const std::size_t> homes, std::vector<bool>& taken) {
    const std::size_t mask = taken.size() - 1;
    for (std::size_t d = 0; d < taken.size(); ++d) {
        auto is_free = [&](std::size_t home) { return !taken[(home + d) & mask]; };
        if (!std::all_of(homes.begin(), homes.end(), is_free)) continue;
        for (std::size_t home : homes) taken[(home + d) & mask] = true;
        displacements_[bucket] = static_cast<std::uint32_t>(d);
        return true;
    }
    return false;
}

} // namespace alhazen
