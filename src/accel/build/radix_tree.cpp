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

namespace {

// How many of the steps 1, 2, ... from a leaf more(step) holds for; it holds up to a step and not beyond.
template <class More>
std::int64_t reach(const More& more) {
    std::int64_t limit = 2;
    while (more(limit)) limit *= 2;
    std::int64_t length = 0;
    for (std::int64_t step = limit / 2; step > 0; step /= 2)
        if (more(length + step)) length += step;
    return length;
}

// The same where it is known not to hold for the given length.
template <class More>
std::int64_t reach_within(std::int64_t length, const More& more) {
    std::int64_t reached = 0, step = length;
    do {
        step = (step + 1) / 2;
        if (reached + step < length && more(reached + step)) reached += step;
    } while (step > 1);
    return reached;
}

// Most ranges are short. Then to look at the first few leaves, all of them and without branches, takes less
// time than to guess wrongly once where a search goes on.
constexpr std::int64_t few = 4;

} // namespace

// The range goes from i towards the neighbour with which i has more in common, as far as leaves have more in
// common with i than the other neighbour has; the split is behind the last leaf that has more in common with
// i than the range's other end has.
RadixTree::Link RadixTree::find(std::int64_t i) const {
    const int after = delta(i, i + 1), before = delta(i, i - 1);
    const std::int64_t d = after > before ? 1 : -1;
    const int outside = std::min(after, before);
    auto link = [&](std::int64_t length, std::int64_t same) -> Link {
        return {static_cast<std::uint32_t>(i + length * d),
                static_cast<std::uint32_t>(i + same * d + std::min<std::int64_t>(d, 0))};
    };
    const MortonKey* keys = keys_.data() + i;
    const bool is_inside = i >= few && i + few < static_cast<std::int64_t>(keys_.size());
    if (is_inside && outside < 64) {
        // To have more bits in common than so many is to differ by less than a power of two.
        std::int64_t length = 0;
        for (std::int64_t s = 1; s <= few; ++s)
            length += (keys->code ^ keys[s * d].code) >> (63 - outside) == 0;
        const std::uint64_t difference = keys->code ^ keys[length * d].code;
        if (length < few && difference) {
            const std::uint64_t highest = std::bit_floor(difference);
            std::int64_t same = 0;
            for (std::int64_t s = 1; s < few; ++s)
                same += static_cast<std::int64_t>((keys->code ^ keys[s * d].code) < highest) & (s < length);
            return link(length, same);
        }
    }
    const std::int64_t length = reach([&](std::int64_t s) { return delta(i, i + s * d) > outside; });
    const int common = delta(i, i + length * d);
    return link(length, reach_within(length, [&](std::int64_t s) { return delta(i, i + s * d) > common; }));
}

} // namespace alhazen
