/// Splits of a handful of references: all ways are tried.
#pragma once

#include "accel/build/binning.h"

namespace alhazen {

/// A way to split up to max_small references.
struct SmallSplit {
    unsigned left = 0; ///< bit i: reference i goes left; 0: there is none
    float cost = infinity;
};
constexpr std::size_t max_small = 4;

/// Of all ways to split 2 ... max_small references the one that costs least; none when areas overflow.
SmallSplit best_small_split(std::span<const Reference> references, const TestCount& tests);

} // namespace alhazen
