/// Tentative collisions of a ray with a medium, drawn from the majorants at one wavelength for all
/// (Miller, Georgiev and Jarosz 2019, "A null-scattering path integral formulation of light transport").
#pragma once

#include "base/hash.h"
#include "media/clear_cells.h"

namespace alhazen {

/// Something that may be an absorption, a scattering, or nothing (a null collision).
struct Collision {
    float t = 0; ///< along the ray
    MediumPoint at;
    Spectrum sigma_maj = 0; ///< the majorant, per unit length
    /// The majorants' transmittance since the collision before, over that at the hero.
    Spectrum transmittance = 1;

    Spectrum sigma_n() const {
        return map(sigma_maj - at.sigma_a - at.sigma_s, [](float v) { return std::max(v, 0.0f); });
    }
};

class Collisions {
  public:
    /// colors: the medium's at these wavelengths. hero: the lane whose majorant places the collisions. The
    /// ray is in world space, up to its tmax; u in [0, 1) places the first collision, the generator the
    /// others. clear: where no surface can be, when the ray may meet one before its tmax; nullptr when it
    /// cannot. The medium and clear must outlive this.
    Collisions(const Medium& medium, const Ray& ray, const Wavelengths& lambda, const MediumColors& colors,
               int hero, float u, Rng rng, const ClearCells* clear = nullptr)
        : medium_(medium), lambda_(lambda), ray_(medium.to_medium(ray)), walk_(medium.majorants(), ray_),
          colors_(colors), sigma_t_(colors_.sigma_t()), hero_(hero), first_u_(u), rng_(rng),
          length_of_d_(length(ray.d)), is_grey_(sigma_t_ == Spectrum(sigma_t_[hero])), clear_(clear),
          began_outside_(!walk_.is_in_cell() || walk_.begin() > 0) {}

    /// The next collision; nullopt when the ray has reached its end, or needs_surface().
    std::optional<Collision> next();
    /// What comes next depends on where the ray meets a surface, which meet() has to say.
    bool needs_surface() const { return clear_ && !stays_clear(); }
    /// The nearest surface is at t; infinity or the ray's tmax for none. next() goes on.
    void meet(float t) {
        clear_ = nullptr;
        walk_.limit(t);
    }
    /// The next random number, for whoever decides what a collision was.
    float uniform() { return rng_.uniform(); }
    /// After the last collision: the transmittance from it to the ray's end, over that at the hero.
    Spectrum transmittance() const {
        if (is_grey_) return 1;
        const float hero = sigma_t_[hero_];
        // Nothing passes through infinitely much.
        return map(sigma_t_, [&](float s) { return s == hero ? 1.0f : std::exp(-(s - hero) * depth_); });
    }

    /// The same of the hero, by itself.
    float hero_transmittance() const { return std::exp(-sigma_t_[hero_] * depth_); }

  private:
    /// Whether there is no surface up to the end of the segment to come; at the end, none up to there.
    bool stays_clear() const {
        if (began_outside_) return false;
        return walk_.is_in_cell() ? clear_->contains(walk_.cell()) : walk_.begin() >= ray_.tmax;
    }

    const Medium& medium_;
    const Wavelengths& lambda_;
    Ray ray_;
    MajorantWalk walk_;
    MediumColors colors_;
    Spectrum sigma_t_;
    int hero_;
    std::optional<float> first_u_;
    Rng rng_;
    float length_of_d_; ///< in the world, where lengths count
    bool is_grey_;
    const ClearCells* clear_;
    bool began_outside_;
    std::optional<float> left_; ///< how much majorant times length there is to the next collision, when drawn
    MajorantSegment segment_;
    float t_ = 0;
    float depth_ = 0; ///< majorant times length, passed since the last collision
};

} // namespace alhazen
