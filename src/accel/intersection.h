/// What a ray meets first, as the acceleration structures know it.
#pragma once

#include <cstdint>

#include "base/vec.h"

namespace alhazen {

inline constexpr std::uint32_t no_primitive = 0xffffffffu;

/// The nearest hit so far. u and v are the primitive's own parameters (barycentric coordinates of a
/// triangle's second and third vertex; a quadric's parameters).
struct Intersection {
    float t = infinity; ///< along the ray
    float u = 0, v = 0;
    std::uint32_t primitive = no_primitive; ///< number in the object's list of primitives
    std::uint32_t instance = 0;             ///< 0 for the scene's own primitives, else instance number + 1

    bool found() const { return primitive != no_primitive; }
};

} // namespace alhazen
