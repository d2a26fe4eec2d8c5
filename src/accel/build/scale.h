/// Areas that neither overflow nor vanish: boxes are compared after a multiplication by a power of two that
/// brings the scene to the size of about one. That changes no digit of a coordinate, so comparisons of areas
/// come out as if floats had no limits.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/bounds.h"

namespace alhazen {

/// The power of two by which boxes inside the given one have coordinates of at most 1 (between 2^-130 and
/// 2^120; 1 for a box that is the origin or empty).
inline float unit_scale(const Bounds3& box) {
    float largest = box.empty() ? 0 : std::max(max_component(abs(box.lo)), max_component(abs(box.hi)));
    if (!(largest > 0)) return 1;
    int exponent = 0;
    std::frexp(largest, &exponent);
    return std::ldexp(1.0f, std::min(-exponent, 120));
}

/// A box times a power of two.
inline Bounds3 scaled(const Bounds3& box, float scale) {
    return {box.lo * scale, box.hi * scale};
}

} // namespace alhazen
