/// From points known in double precision to single precision, with a bound of what is lost.
#pragma once

#include "base/ray.h"

namespace alhazen {

/// Bound of the error of Vec3(p), per axis: half a unit in the last place, plus magnitude x 1e-15 for the
/// double-precision arithmetic that led to p (magnitude: the largest numbers it went through).
inline Vec3 rounding_error(Vec3d p, Vec3d magnitude) {
    Vec3 error;
    for (int i = 0; i < 3; ++i) {
        double bound = std::abs(p[i]) * 0x1p-24 + std::abs(magnitude[i]) * 1e-15;
        error[i] = next_up(static_cast<float>(bound));
    }
    return error;
}

inline Vec3d abs_sum(Vec3d a, Vec3d b, Vec3d c) {
    return abs(a) + abs(b) + abs(c);
}

} // namespace alhazen
