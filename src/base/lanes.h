/// Four floats in one register, through the vector extensions that GCC and clang share: one text for every
/// processor, without intrinsics.
#pragma once

#include <cstring>

#include "base/vec.h"

namespace alhazen {

/// Four float lanes; + - * / and comparisons work lane by lane. A comparison gives lanes of int: -1 or 0.
using Lanes4 = float __attribute__((vector_size(16)));
using IntLanes4 = int __attribute__((vector_size(16)));

inline Lanes4 all_lanes(float v) {
    return Lanes4{v, v, v, v};
}
inline Lanes4 to_lanes(Vec3 v, float fourth = 0) {
    return Lanes4{v.x, v.y, v.z, fourth};
}
inline Vec3 to_vec3(Lanes4 v) {
    return {v[0], v[1], v[2]};
}
/// The smaller of each lane; keep's lane where v's is NaN.
inline Lanes4 min_lanes(Lanes4 v, Lanes4 keep) {
    return v < keep ? v : keep;
}
/// The larger of each lane; keep's lane where v's is NaN.
inline Lanes4 max_lanes(Lanes4 v, Lanes4 keep) {
    return v > keep ? v : keep;
}
/// {low[0], low[1], high[0], high[1]}.
inline Lanes4 join_pairs(const float* low, const float* high) {
    using Pair = float __attribute__((vector_size(8)));
    Pair l, h;
    std::memcpy(&l, low, sizeof l);
    std::memcpy(&h, high, sizeof h);
    return __builtin_shufflevector(l, h, 0, 1, 2, 3);
}

} // namespace alhazen
