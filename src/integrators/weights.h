/// Multiple importance sampling weights, and the light samplers that integrators offer.
#pragma once

#include <array>

#include "describe/field_types.h"

namespace alhazen {

/// Weight of a sample drawn with density pdf where another technique would have drawn it with density other;
/// 1 when no other technique could. Veach 1997, section 9.2.3, exponent 2.
inline float power_heuristic(float pdf, float other, bool only_technique) {
    if (only_technique || other == 0) return 1;
    if (!(pdf < infinity)) return 1;
    // The ratio first: squares of densities overflow.
    float ratio = other / pdf;
    return 1 / (1 + ratio * ratio);
}

enum class LightSampler { uniform, power, bvh };
template <>
struct EnumNames<LightSampler> {
    static constexpr std::array names{"uniform", "power", "bvh"};
};

} // namespace alhazen
