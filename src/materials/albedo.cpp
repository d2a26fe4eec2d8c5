#include "materials/albedo.h"

#include <cmath>

namespace alhazen {

Spectrum albedo_of(const Bsdf& bsdf, Vec3 wo, int samples, TransportMode mode, Vec3 shift) {
    auto fraction = [](float v) { return std::min(v - std::floor(v), one_minus_epsilon); };
    const auto count = static_cast<float>(samples);
    Spectrum sum = 0;
    for (int i = 0; i < samples; ++i) {
        const float n = static_cast<float>(i) + 0.5f;
        const Vec2 u2{fraction(n * 0.7548777f + shift.y), fraction(n * 0.5698403f + shift.z)};
        if (auto s = bsdf.sample(wo, fraction(n / count + shift.x), u2, mode)) sum += s->f * (1 / s->pdf);
    }
    return sum * (1 / count);
}

} // namespace alhazen
