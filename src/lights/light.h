/// Lights: where paths end. Point-like and distant lights, environments, and glowing shapes.
#pragma once

#include <optional>

#include "base/bounds.h"
#include "base/hit.h"
#include "color/spectrum_value.h"
#include "describe/kind.h"
#include "describe/spectrum_parameter.h"

namespace alhazen {

/// A point that light arrives at. ns is zero where there is no surface.
struct LightReceiver {
    Vec3 p;
    Vec3 ns;
};

/// Light chosen at a light, arriving at a receiver.
struct LightSample {
    Spectrum L; ///< radiance (delta lights: irradiance perpendicular to wi) arriving if nothing is in the way
    Vec3 wi;    ///< unit, from the receiver to the light
    float pdf = 0;   ///< per steradian; 1 for delta lights
    Vec3 p, p_error; ///< where on the light; for infinitely distant ones, a point beyond the scene
    Vec3 ng;         ///< normal there; zero when not on a surface
    float primitive_u = 0, primitive_v = 0;
};

/// Light that sets out from a light: the beginning of a path that goes with the light.
struct LeavingLight {
    Ray ray; ///< into the scene; unit direction
    Spectrum
        L; ///< radiance along the ray; of points the intensity, of distant lights the irradiance across it
    float pdf_position = 0; ///< per area of the surface, or of the disk far light comes through; 1 for points
    float pdf_direction = 0; ///< per steradian; 1 for distant lights
    Vec3 p, p_error;         ///< where on the light, as in LightSample
    Vec3 ng;                 ///< normal there; zero when not on a surface
    Vec2 uv;
    float cosine = 1;   ///< of the ray and ng, without sign; 1 when not on a surface
    float presence = 1; ///< the chance that the surface is there, by its alpha; L counts it in already
    /// False for light that keeps its strength at any distance, unlike real light: the further its rays have
    /// spread, the more they carry, by the distance squared.
    bool fades = true;

    /// The flux that the ray stands for.
    Spectrum flux() const { return L * (cosine / (pdf_position * pdf_direction)); }
};

/// The densities with which sample_leaving() gives a ray.
struct LeavingPdf {
    float position = 0, direction = 0;
};

/// Where a light is and which way it shines: what the light BVH needs (Conty Estevez and Kulla 2018,
/// section 4.1).
struct LightBounds {
    Bounds3 bounds;
    Vec3 axis{0, 0, 1};     ///< unit; middle of the emitting normals
    float cos_normals = -1; ///< cosine of the normals' half angle around the axis
    float cos_falloff = 0;  ///< cosine of how far from its normal a point still emits
    float power = 0;        ///< flux in arbitrary but common units (visible average)
    bool two_sided = false;
};

/// A light without size that shines alike in all directions.
struct EvenPoint {
    Vec3 p;
    Spectrum intensity;
    bool fades = true; ///< with the square of the distance
};

struct Light {
    static constexpr std::string_view family_name = "light";
    virtual ~Light() = default;

    /// Once the scene's extent is known: infinite lights need it to give power and points beyond the scene.
    virtual void prepare(const Bounds3& /*scene*/) {}

    /// Light arriving at the receiver from a point of the light chosen with u; nullopt when none does.
    virtual std::optional<LightSample> sample(const LightReceiver& at, Vec2 u,
                                              const Wavelengths& lambda) const = 0;

    /// Light leaving the light, its place chosen with u1 and its direction with u2; nullopt when none does.
    virtual std::optional<LeavingLight> sample_leaving(Vec2 u1, Vec2 u2, const Wavelengths& lambda,
                                                       float time) const = 0;
    /// The densities of that for light leaving along w (unit); ng is the normal at an area light's point. A
    /// point's position and a distant light's direction have density 1, as other ones are never asked for.
    virtual LeavingPdf pdf_leaving(Vec3 ng, Vec3 w) const = 0;

    /// Delta lights (points, directions) cannot be met by a ray.
    virtual bool is_delta() const { return false; }
    /// Whether sample() looks at u.
    virtual bool has_extent() const { return !is_delta(); }
    /// Infinite lights surround the scene and are seen by rays that leave it.
    virtual bool is_infinite() const { return false; }
    /// Infinitely far away: light from one direction is parallel.
    virtual bool is_far() const { return is_infinite(); }

    /// Area lights: radiance leaving the hit in direction hit.wo.
    virtual Spectrum emitted(const Hit& /*hit*/, const Wavelengths& /*lambda*/) const { return 0; }
    /// Area lights: density per steradian with which sample() would choose the hit, met along wi from the
    /// receiver.
    virtual float pdf_hit(const LightReceiver&, const Hit& /*hit*/, Vec3 /*wi*/) const { return 0; }
    /// Infinite lights: radiance arriving at p against direction d (unit) and the density of sample()
    /// choosing it.
    virtual Spectrum escaped(Vec3 /*p*/, Vec3 /*d*/, const Wavelengths& /*lambda*/) const { return 0; }
    virtual float pdf_escaped(const LightReceiver&, Vec3 /*d*/) const { return 0; }

    /// The same two for integrators that also draw directions from BSDFs and weigh both by their densities:
    /// light that is found well enough so may be left out here (Karlik et al. 2019, "MIS compensation").
    virtual std::optional<LightSample> sample_beside_bsdf(const LightReceiver& at, Vec2 u,
                                                          const Wavelengths& lambda) const {
        return sample(at, u, lambda);
    }
    virtual float pdf_escaped_beside_bsdf(const LightReceiver& at, Vec3 d) const {
        return pdf_escaped(at, d);
    }

    /// nullopt for infinite lights.
    virtual std::optional<LightBounds> bounds() const { return std::nullopt; }
    /// Of lights that are nothing else: sample() needs not be called for each point then.
    virtual std::optional<EvenPoint> even_point(const Wavelengths& /*lambda*/) const { return std::nullopt; }
    /// Flux at the wavelengths, watts; infinite lights: through the scene's bounding disk (after prepare()).
    virtual Spectrum power(const Wavelengths& lambda) const = 0;
};

/// Lights that a LightSource directive names; context.world_from_node places them.
const KindList<Light>& light_kinds();

} // namespace alhazen
