/// Which way light goes on when a medium scatters it (Henyey and Greenstein 1941).
#pragma once

#include "base/frame.h"

namespace alhazen {

struct PhaseSample {
    Vec3 wi;
    float pdf = 0; ///< per steradian; also the phase function's value
};

/// Directions are unit length and point away from the point, as at surfaces: light that goes straight on has
/// wi = -wo.
class HenyeyGreenstein {
  public:
    HenyeyGreenstein() = default;
    /// g: mean cosine between the directions before and after; 0 is isotropic, 1 straight on. Kept off +-1,
    /// where the function becomes a delta distribution.
    explicit HenyeyGreenstein(float g) : g_(std::clamp(g, -largest, largest)) {}

    float g() const { return g_; }
    /// Per steradian; also the density of sample().
    float eval(Vec3 wo, Vec3 wi) const { return value(-dot(wo, wi)); }
    /// u uniform in the unit square.
    PhaseSample sample(Vec3 wo, Vec2 u) const {
        // The distribution function of the cosine, inverted; near g = 0 that divides by nothing.
        float cosine = 1 - 2 * u.x;
        if (std::abs(g_) > 1e-3f)
            cosine = (1 + sqr(g_) - sqr((1 - sqr(g_)) / (1 + g_ - 2 * g_ * u.x))) / (2 * g_);
        cosine = std::clamp(cosine, -1.0f, 1.0f);
        const float sine = safe_sqrt(1 - sqr(cosine)), phi = 2 * pi * u.y;
        const Vec3 wi = Frame::from_z(-wo).to_world({sine * std::cos(phi), sine * std::sin(phi), cosine});
        return {wi, value(cosine)};
    }

  private:
    static constexpr float largest = 0.999f;
    // cosine: between the directions of travel.
    float value(float cosine) const {
        const float below = 1 + sqr(g_) - 2 * g_ * cosine;
        return inv_pi / 4 * (1 - sqr(g_)) / (below * safe_sqrt(below));
    }

    float g_ = 0;
};

} // namespace alhazen
