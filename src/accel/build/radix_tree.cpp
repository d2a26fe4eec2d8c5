#include "accel/build/radix_tree.h"

namespace alhazen {

RadixTree::RadixTree(std::span<const MortonKey> keys)
    : keys_(keys), nodes_(inner()), inner_parent_(inner()), leaf_parent_(leaves()) {
    if (inner() == 0) {
        if (leaves() == 1) leaf_parent_[0] = none;
        return;
    }
    inner_parent_[0] = none;
    parallel_ranges(inner(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Link l = nodes_[i] = find(static_cast<std::int64_t>(i));
            Node n = node(i);
            auto own = static_cast<std::uint32_t>(i);
            (n.first == l.split ? leaf_parent_ : inner_parent_)[l.split] = own;
            (n.last == l.split + 1 ? leaf_parent_ : inner_parent_)[l.split + 1] = own;
        }
    });
}

// The length of the common prefix of two leaves' keys, a key being a code and behind it its place; -1 where
// there is no leaf j.
int RadixTree::delta(std::int64_t i, std::int64_t j) const {
    if (j < 0 || j >= static_cast<std::int64_t>(keys_.size())) return -1;
    std::uint64_t difference =
        keys_[static_cast<std::size_t>(i)].code ^ keys_[static_cast<std::size_t>(j)].code;
    if (difference) return std::countl_zero(difference);
    return 64 + std::countl_zero(static_cast<std::uint32_t>(i ^ j));
}

// The range goes from i towards the neighbour with which i has more in common, as far as leaves have more in
// common with i than the other neighbour has; the split is behind the last leaf that has more in common with
// i than the range's other end has.
RadixTree::Link RadixTree::find(std::int64_t i) const {
    const int after = delta(i, i + 1), before = delta(i, i - 1);
    const std::int64_t d = after > before ? 1 : -1;
    const int outside = std::min(after, before);
    std::int64_t limit = 2;
    while (delta(i, i + limit * d) > outside) limit *= 2;
    std::int64_t length = 0;
    for (std::int64_t step = limit / 2; step > 0; step /= 2)
        if (delta(i, i + (length + step) * d) > outside) length += step;
    const std::int64_t j = i + length * d;

    const int common = delta(i, j);
    std::int64_t same = 0, step = length;
    do {
        step = (step + 1) / 2;
        if (delta(i, i + (same + step) * d) > common) same += step;
    } while (step > 1);
    const std::int64_t split = i + same * d + std::min<std::int64_t>(d, 0);
    return {static_cast<std::uint32_t>(j), static_cast<std::uint32_t>(split)};
}

} // namespace alhazen
