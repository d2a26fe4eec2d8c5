/// What happens to light at one point of a surface. Plain numbers only: no textures, no hit, no scene.
#pragma once

#include <cstdint>
#include <optional>

#include "base/frame.h"
#include "color/spectrum.h"

namespace alhazen {

/// Which way light is followed. Radiance that is refracted is squeezed by eta^2; importance is not (Veach
/// 1997, section 5.2).
enum class TransportMode { radiance, importance };

/// The parts of a BSDF, as a set of bits.
enum class Lobes : std::uint8_t {
    none = 0,
    reflection = 1,
    transmission = 2,
    diffuse = 4,
    glossy = 8,
    specular = 16, ///< perfect mirror or refraction: a delta distribution
};
constexpr Lobes operator|(Lobes a, Lobes b) {
    return static_cast<Lobes>(static_cast<std::uint8_t>(a) | static_cast<std::uint8_t>(b));
}
constexpr bool has(Lobes set, Lobes any_of) {
    return (static_cast<std::uint8_t>(set) & static_cast<std::uint8_t>(any_of)) != 0;
}

/// The value of a BSDF for a pair of directions.
struct Scatter {
    Spectrum f;            ///< BSDF times |cos(wi)|
    float pdf = 0;         ///< density of sampling wi given wo, per steradian
    float pdf_reverse = 0; ///< density of sampling wo given wi
};

struct BsdfSample {
    Vec3 wi;
    Spectrum f;    ///< BSDF times |cos(wi)|; for specular lobes its integral, so that f / pdf is the weight
    float pdf = 0; ///< per steradian; for specular lobes the probability of choosing the lobe
    float pdf_reverse = 0;
    Lobes lobes =
        Lobes::none; ///< of the sampled part: reflection or transmission, with diffuse, glossy or specular
    float eta = 1;   ///< for transmission: index on the side of wi over that on the side of wo
};

/// What the Whitted integrator needs besides local(): the textbook's constants.
struct WhittedTerms {
    Spectrum ambient = 0; ///< ka, times the ambient light
    Spectrum mirror = 0;  ///< kr
    Spectrum refract = 0; ///< kt
    float eta = 1;        ///< index inside over the index outside
};

/// The terms of Phong's formula.
struct PhongTerms {
    Spectrum diffuse, specular; ///< kd, ks
    float shininess = 0;        ///< n
};

/// Two formulas for the highlights of textbook surfaces.
enum class Highlight {
    phong, ///< (R.V)^n, R the mirrored direction of the light (Phong 1975)
    blinn, ///< (N.H)^(4 n), H halfway between light and eye (Blinn 1977); the factor 4 makes it about as wide
};

/// A BSDF at a point. Directions are unit length, point away from the surface, and live in the local frame
/// (shading normal = +z). Made in an Arena by a Material: must be trivially destructible.
struct Bsdf {
    /// Value and densities without the specular lobes; zero where wo.z or wi.z is 0.
    virtual Scatter eval(Vec3 wo, Vec3 wi, TransportMode mode = TransportMode::radiance) const = 0;
    /// A direction with density eval().pdf, or a specular one. u chooses among lobes, u2 within; uniform in
    /// [0, 1). nullopt when the sample is lost (absorbed, below the surface).
    virtual std::optional<BsdfSample> sample(Vec3 wo, float u, Vec2 u2,
                                             TransportMode mode = TransportMode::radiance) const = 0;
    /// The parts it has.
    virtual Lobes lobes() const = 0;
    /// Where true, eval().f is random with the BSDF as its mean (the same for the same directions and place),
    /// sample() gives an f such that f / pdf has the right mean in each direction, and pdf is a density near
    /// that of its directions: the same number from sample() and eval(), which is all that weighing them
    /// needs.
    virtual bool is_stochastic() const { return false; }
    /// Widens narrow lobes, so that paths which are hard to sample are blurred instead of missed.
    virtual void regularize() {}

    virtual WhittedTerms whitted(Vec3 /*wo*/) const { return {}; }
    /// The response of local illumination to a light in direction wi: eval().f, or Phong's empirical formula.
    virtual Spectrum local(Vec3 wo, Vec3 wi, Highlight /*highlight*/ = Highlight::phong) const {
        return eval(wo, wi).f;
    }

    /// Of surfaces that do nothing but scatter evenly to the side that light comes from: their BSDF, so that
    /// eval().f is that times |cos(wi)| where both directions are on one side. Local light of many points is
    /// then summed without a call a point.
    virtual std::optional<Spectrum> matte() const { return std::nullopt; }
    /// Of surfaces whose local() is Phong's formula, what stands in it: local light of many points is then
    /// found together.
    virtual std::optional<PhongTerms> phong() const { return std::nullopt; }

  protected:
    ~Bsdf() = default;
};

} // namespace alhazen
