/// A clear or cloudy layer between a dielectric border and an opaque base: lacquered wood, varnished metal.
///
/// Light that enters bounces between border and base, and scatters within the layer, until it leaves through
/// the border. All of that is taken to happen at one point, so that only directions and depths count:
/// position-free random walks (Guo, Hasan and Zhao 2018, "Position-free Monte Carlo simulation for arbitrary
/// layered BSDFs"; Pharr et al. 2023, section 14.3). The layer's extinction is 1 whatever it scatters, so
/// that one without albedo absorbs (as pbrt-v4).
///
/// What keeps integrators unbiased, though eval() and sample() are random:
/// - eval().f is a walk towards both directions, with the BSDF as its mean. Its random numbers are a hash of
/// the
///   directions and of the place: the place, because a parallel camera and a distant light would else see one
///   and the same estimate everywhere and always.
/// - sample() follows a walk until it leaves. f / pdf is the walk's weight, whose mean in each direction is
/// the
///   BSDF; that, and nothing else, is what a throughput is multiplied by.
/// - The density of the directions that walks leave in is not known. pdf is instead density(), a formula near
///   it that depends on the two directions alone. Integrators use it to weigh light sampling against BSDF
///   sampling, and those weights sum to one whatever the formula says, because both sides ask the same one.
///   (pbrt-v4 has a random estimate in this place, which makes the weights, and so the picture, noisier.)
/// Within a walk, directions found from the border and from the base are weighed by their true densities.
/// (pbrt-v4 weighs the border's by the density of the way back, so that its weights sum to a little more than
/// one where border and base are both rough; what it renders by light sampling is brighter there by as much.)
#pragma once

#include "base/hash.h"
#include "base/hit.h"
#include "materials/conductor_bsdf.h"
#include "materials/dielectric_bsdf.h"
#include "materials/diffuse_bsdf.h"
#include "math/phase.h"

namespace alhazen {

/// What is between the border and the base.
struct Layer {
    float thickness = 0.01f; ///< mean free paths
    Spectrum albedo = 0;     ///< fraction of light that is scattered, not absorbed, where it meets a particle
    HenyeyGreenstein phase;
    int maxdepth = 10; ///< ways from border to base or back, each up to a particle if it meets one
    int nsamples = 1;  ///< walks of one evaluation

    /// What is left of light after the height h in direction w.
    float transmittance(float h, Vec3 w) const { return w.z != 0 ? std::exp(-std::abs(h / w.z)) : 0; }
    bool is_cloudy() const { return !albedo.is_black(); }
};

/// A number for each place, which its walks' random numbers come from.
std::uint64_t place_salt(const Hit& hit);

/// Base: DiffuseBsdf or ConductorBsdf. Both faces are coated alike, and light never gets through. What
/// refraction squeezes on the way in is stretched on the way out: radiance and importance need not be told
/// apart.
template <class Base>
class LayeredBsdf final : public Bsdf {
  public:
    LayeredBsdf(const DielectricBsdf& border, const Base& base, const Layer& layer, std::uint64_t salt)
        : border_(border), base_(base), layer_(layer), salt_(salt) {}

    Scatter eval(Vec3 wo, Vec3 wi, TransportMode mode) const override;
    std::optional<BsdfSample> sample(Vec3 wo, float u, Vec2 u2, TransportMode mode) const override;
    bool is_stochastic() const override { return !is_mirror(); }
    Lobes lobes() const override;
    void regularize() override {
        border_.regularize();
        base_.regularize();
    }
    WhittedTerms whitted(Vec3 wo) const override;

  private:
    /// A walk through the layer.
    struct Walk {
        Vec3 w;          ///< where it goes
        float height;    ///< above the base
        Spectrum weight; ///< what is left of its light
        int depth = 0;
        bool is_specular = false; ///< so far
    };
    /// The other end of an evaluation: how light gets out in direction wi.
    struct Exit {
        Vec3 wi;
        Vec3 up;         ///< the way to the border that is refracted into wi
        Spectrum weight; ///< border's share of the BSDF, times |cos(wi)|, over pdf
        float pdf;       ///< density with which the border chose up
    };

    bool is_mirror() const { return border_.is_specular() && base_is_specular() && !layer_.is_cloudy(); }
    bool base_is_specular() const { return has(base_.lobes(), Lobes::specular); }

    Spectrum between(Vec3 wo, Vec3 wi, Rng& rng) const;
    Spectrum leave_from_base(Walk& walk, const Exit& exit, Rng& rng) const;
    Spectrum leave_from_particle(Walk& walk, const Exit& exit, Rng& rng) const;
    Spectrum mirrored_exit(const Walk& walk, const Exit& exit) const;
    Spectrum echoes(const Exit& exit) const;
    Spectrum leave_along(const Walk& walk, const Exit& exit, float pdf) const;
    bool goes_on(Walk& walk, Rng& rng) const;
    bool meets_particle(Walk& walk, Rng& rng) const;

    std::optional<BsdfSample> follow(Walk walk, Vec3 wo, Vec2 u2, Rng& rng) const;
    BsdfSample finish(Vec3 wo, Vec3 wi, Spectrum weight, bool is_specular) const;
    Spectrum mirrored(Vec3 wo) const;
    float density(Vec3 wo, Vec3 wi) const;

    DielectricBsdf border_;
    Base base_;
    Layer layer_;
    std::uint64_t salt_;
};

extern template class LayeredBsdf<DiffuseBsdf>;
extern template class LayeredBsdf<ConductorBsdf>;

} // namespace alhazen
