#include "accel/build/small_split.h"

namespace alhazen {

namespace {

// The boxes around every subset of the references.
struct Subsets {
    std::array<RawBox, 1u << max_small> box;

    explicit Subsets(std::span<const Reference> references) {
        box[0].clear();
        for (unsigned set = 1; set < 1u << references.size(); ++set) {
            // One more than a subset before.
            unsigned rest = set & (set - 1);
            const Reference& r = references[static_cast<std::size_t>(std::countr_zero(set))];
            box[set] = box[rest];
            box[set].extend(r.lo, r.hi);
        }
    }
};

} // namespace

SmallSplit best_small_split(std::span<const Reference> references, const TestCount& tests) {
    Subsets subsets(references);
    const unsigned all = (1u << references.size()) - 1;
    std::array<float, max_small + 1> test_count{};
    for (std::size_t n = 1; n <= references.size(); ++n) test_count[n] = tests(n);
    auto cost_of = [&](unsigned set) {
        return subsets.box[set].half_area() * test_count[static_cast<std::size_t>(std::popcount(set))];
    };
    SmallSplit best;
    // The first reference is always left: the mirror images are the same splits.
    for (unsigned left = 1; left < all; left += 2) {
        float cost = cost_of(left) + cost_of(all & ~left);
        if (cost < best.cost) best = {left, cost};
    }
    return best;
}

} // namespace alhazen
