/// A rough surface as a landscape of tiny mirrors (microfacets): how their normals are spread, how much of
/// them is seen from a direction, and how to pick one that is seen. Trowbridge and Reitz 1975 (GGX, Walter et
/// al. 2007), with two roughnesses across and along; visible normals sampled as Heitz 2018 ("Sampling the GGX
/// distribution of visible normals"). The picture: the landscape is a stretched hemisphere, so squeezing
/// space by alpha turns everything into questions about a plain one.
#pragma once

#include "base/frame.h"

namespace alhazen {

class TrowbridgeReitz {
  public:
    TrowbridgeReitz() = default;
    /// alpha: tangent of the typical slope along x and y; 0 is flat.
    TrowbridgeReitz(float alpha_x, float alpha_y) : ax_(alpha_x), ay_(alpha_y) {
        // Between smooth and here, floats cannot tell the narrow peak from noise.
        if (!is_smooth()) {
            ax_ = std::max(ax_, min_alpha);
            ay_ = std::max(ay_, min_alpha);
        }
    }

    /// pbrt-v4's map from the parameter "roughness" to alpha, which looks even to the eye.
    static float roughness_to_alpha(float roughness) { return safe_sqrt(roughness); }

    /// Taken for a perfect mirror.
    bool is_smooth() const { return std::max(ax_, ay_) < smooth_below; }
    /// Widens sharp peaks (pbrt-v4's rule).
    void regularize() {
        if (ax_ < 0.3f) ax_ = std::clamp(2 * ax_, 0.1f, 0.3f);
        if (ay_ < 0.3f) ay_ = std::clamp(2 * ay_, 0.1f, 0.3f);
    }

    /// With the slopes of another landscape added, their squares scaled by factor.
    TrowbridgeReitz widened_by(const TrowbridgeReitz& other, float factor) const {
        return {std::sqrt(sqr(ax_) + factor * sqr(other.ax_)), std::sqrt(sqr(ay_) + factor * sqr(other.ay_))};
    }
    float alpha_x() const { return ax_; }
    float alpha_y() const { return ay_; }

    /// Area of facets with normal wm per area of the flat surface and solid angle.
    float density(Vec3 wm) const {
        float cos2 = sqr(wm.z);
        if (cos2 < 1e-16f) return 0;
        float slope2 = (sqr(wm.x / ax_) + sqr(wm.y / ay_)) / cos2;
        return inv_pi / (ax_ * ay_ * sqr(cos2) * sqr(1 + slope2));
    }
    /// Smith's Lambda: hidden over visible facet area, seen from w.
    float lambda(Vec3 w) const {
        if (w.z == 0) return infinity;
        float slope2 = (sqr(w.x * ax_) + sqr(w.y * ay_)) / sqr(w.z);
        return (std::sqrt(1 + slope2) - 1) / 2;
    }
    /// Fraction of facets seen from w.
    float visible(Vec3 w) const { return 1 / (1 + lambda(w)); }
    /// Fraction seen from both; height-correlated (Heitz 2014).
    float visible(Vec3 wo, Vec3 wi) const { return 1 / (1 + lambda(wo) + lambda(wi)); }
    /// Density of the normals that w sees, per solid angle: what sample() draws.
    float visible_density(Vec3 w, Vec3 wm) const {
        if (w.z == 0) return 0;
        return visible(w) / std::abs(w.z) * density(wm) * abs_dot(w, wm);
    }
    /// A facet's normal (wm.z >= 0) that w sees; u uniform in the unit square. For w below, the landscape is
    /// seen through from below.
    Vec3 sample(Vec3 w, Vec2 u) const {
        // The hemisphere in which the landscape is a hemisphere.
        Vec3 wh = normalize(Vec3(ax_ * w.x, ay_ * w.y, w.z));
        if (wh.z < 0) wh = -wh;
        float across2 = sqr(wh.x) + sqr(wh.y);
        Vec3 t1 = across2 > 1e-12f ? Vec3(-wh.y, wh.x, 0) / std::sqrt(across2) : Vec3(1, 0, 0);
        Vec3 t2 = cross(wh, t1);
        // A point of the hemisphere's projection along wh: a disk whose far half is squeezed by the tilt.
        float r = std::sqrt(u.x), phi = 2 * pi * u.y;
        float p1 = r * std::cos(phi);
        float p2 = lerp(0.5f * (1 + wh.z), safe_sqrt(1 - sqr(p1)), r * std::sin(phi));
        float pz = safe_sqrt(1 - sqr(p1) - sqr(p2));
        Vec3 n = t1 * p1 + t2 * p2 + wh * pz;
        return normalize(Vec3(ax_ * n.x, ay_ * n.y, std::max(1e-6f, n.z)));
    }

  private:
    static constexpr float smooth_below = 1e-3f, min_alpha = 1e-4f;
    float ax_ = 0, ay_ = 0;
};

} // namespace alhazen
