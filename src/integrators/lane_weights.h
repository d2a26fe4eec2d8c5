/// What a path through media is worth at each of its wavelengths. One wavelength, the hero, draws every step
/// for all, with densities that may be far from the others' own; so each contribution is divided by the mean,
/// over the wavelengths, of the density with which each would have made the same path (single-sample multiple
/// importance sampling; Wilkie et al. 2014; Miller, Georgiev and Jarosz 2019, section 5).
#pragma once

#include "color/wavelengths.h"
#include "media/collisions.h"

namespace alhazen {

class LaneWeights {
  public:
    LaneWeights() = default;
    /// u in [0, 1) picks the hero. Sampled wavelengths come in random order, so that the first will do.
    LaneWeights(const Wavelengths& lambda, float u)
        : lanes_(lambda.mode == ColorMode::rgb ? 3 : 4),
          hero_(lambda.mode == ColorMode::rgb ? std::min(static_cast<int>(u * 3), 2) : 0) {}

    int hero() const { return hero_; }
    /// Takes notice that the wavelengths have parted: from now on the hero goes alone.
    void follow(const Wavelengths& lambda) {
        if (lanes_ == 1 || !lambda.secondary_terminated()) return;
        lanes_ = 1;
        path_ = Spectrum(path_[0]);
        light_ = Spectrum(light_[0]);
    }

    /// Light that only this way of sampling finds.
    Spectrum alone(Spectrum L) const { return beta_ * L / mean(path_); }
    /// Light found by a scattered ray that light sampling would have chosen with the density.
    Spectrum beside_light(Spectrum L, float light_pdf) const {
        return beta_ * L / mean(path_ + light_ * light_pdf);
    }
    /// Light chosen with a density light_pdf, by which value is divided, that scattering would have found
    /// with scatter_pdf. After begin_shadow and the crossing of what lies between.
    Spectrum from_light(Spectrum value, float light_pdf, float scatter_pdf) const {
        const float density = mean(light_ * light_pdf + path_ * scatter_pdf);
        return density < infinity ? beta_ * value * (light_pdf / density) : Spectrum(0);
    }
    /// Light that the medium emits where the collision was.
    Spectrum emitted(const Collision& c) const {
        const Spectrum reached = c.transmittance * (1 / c.sigma_maj[hero_]);
        return beta_ * reached * c.at.sigma_a * c.at.Le / mean(path_ * reached * c.sigma_maj);
    }

    /// A direction was drawn with a density; weight: what is scattered over it.
    void scatter(Spectrum weight, float pdf) {
        beta_ *= weight;
        light_ = path_ / pdf;
    }
    void scale(float s) { beta_ *= s; }
    /// The ray reached its end after the last collision. by_light: the density with which light sampling
    /// would have come through from there, over the hero's.
    void pass(Spectrum transmittance, Spectrum by_light) {
        beta_ *= transmittance;
        path_ *= transmittance;
        light_ *= by_light;
    }
    /// The collision was none. (Light sampling draws no such choices: it passes with certainty.)
    void pass_null(const Collision& c) {
        const Spectrum sigma_n = c.sigma_n(), t = c.transmittance * (1 / sigma_n[hero_]);
        beta_ *= t * sigma_n;
        path_ *= t * sigma_n;
        light_ *= t * c.sigma_maj;
    }
    void collide(const Collision& c) {
        const Spectrum t = c.transmittance * c.at.sigma_s * (1 / c.at.sigma_s[hero_]);
        beta_ *= t;
        path_ *= t;
    }

    /// From here to a light.
    void begin_shadow() { light_ = path_; }
    /// A collision on the way to a light, which weakens it (ratio tracking, Novak et al. 2014).
    void weaken(const Collision& c) {
        const Spectrum t = c.transmittance * (1 / c.sigma_maj[hero_]), through = t * c.sigma_n();
        beta_ *= through;
        path_ *= through;
        light_ *= t * c.sigma_maj;
    }
    /// The end of the way to a light, after the last of these.
    void weaken(Spectrum transmittance) { pass(transmittance, transmittance); }
    /// A way to a light through what weakens it by a known factor; nothing is drawn. Scattered rays would
    /// have come through by chance.
    void weaken_surely(Spectrum transmittance) { pass(transmittance, 1); }
    /// Of two walks with the same hero, joined into one.
    LaneWeights joined(const LaneWeights& other) const {
        LaneWeights both = *this;
        both.beta_ *= other.beta_;
        both.path_ *= other.path_;
        both.lanes_ = std::min(lanes_, other.lanes_);
        return both;
    }
    /// What is brought over a shadow ray by those who weigh it themselves.
    Spectrum through_shadow(Spectrum L) const { return from_light(L, 1, 0); }
    void block() { beta_ = 0; }
    /// Fraction of the light that has come through so far, about.
    float shadow_transmittance() const { return (beta_ / mean(path_ + light_)).max(); }

    bool is_black() const { return beta_.is_black(); }
    /// For Russian roulette: the largest weight of a contribution to come.
    float throughput() const { return (beta_ / mean(path_)).max(); }

  private:
    float mean(Spectrum s) const {
        if (lanes_ == 1) return s[0];
        return lanes_ == 4 ? s.average() : (s[0] + s[1] + s[2]) / 3;
    }

    Spectrum beta_ = 1;  ///< contribution over the density of the walk as the hero drew it
    Spectrum path_ = 1;  ///< each lane's density of the walk over the hero's
    Spectrum light_ = 1; ///< the same with light sampling in place of the last direction
    int lanes_ = 4, hero_ = 0;
};

} // namespace alhazen
