/// Progressive multi-jittered (0,2) points (Christensen, Kensler and Kilpatrick 2018, "Progressive
/// Multi-Jittered Sample Sequences"): of the first 2^k, one lies in each rectangle of size 2^-a x 2^-(k - a),
/// for every a and k.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace alhazen {

/// 2^log2_count points, log2_count <= 24. The order within each 2^k is random too, so that sets of different
/// seeds are not tied to each other.
std::vector<Vec2> pmj02_points(int log2_count, std::uint64_t seed);

} // namespace alhazen
