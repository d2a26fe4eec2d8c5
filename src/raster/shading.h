/// Local illumination: what a point sends to the eye of the light that comes to it straight from the lights.
#pragma once

#include "raster/dispatch.h"
#include "raster/local_lights.h"

namespace alhazen {

/// The part of each light that gets to a point; asked once for each light that would light it.
class LightVisibility {
  public:
    virtual ~LightVisibility() = default;
    /// Of a point with the geometric normal ng and a light towards the unit vector wi. 0: in shadow; 1: fully
    /// lit.
    virtual float lit(Vec3 p, Vec3 ng, std::size_t light, Vec3 wi) const = 0;
};

struct ShadingOptions {
    Highlight highlight = Highlight::phong;
    Spectrum ambient = 0.1f; ///< light that comes from everywhere
};

class LocalShading {
  public:
    /// visibility: nullptr for no shadows. What is given must outlive this.
    LocalShading(const LocalLights& lights, const ShadingOptions& options, const LightVisibility* visibility)
        : lights_(lights), options_(options), visibility_(visibility) {}

    /// Radiance leaving the hit towards hit.wo, in linear RGB: what it emits, and what it makes of the
    /// ambient light, the surroundings and each light. It is Whitted's formula with the surroundings, blurred
    /// as matte surfaces see them, for what mirrors and glass show. bsdf is the hit's material's.
    Spectrum radiance(const Hit& hit, const Bsdf& bsdf) const;
    /// The same of a hit that shows what is behind: as for glass.
    Spectrum behind(const Hit& hit) const { return blurred(-hit.wo); }
    /// The same for matte points, without what they emit.
    void light(RasterPoints& points) const;

  private:
    Spectrum from_lights(const Hit& hit, const Bsdf& bsdf, Vec3 wo, const Frame& frame) const;
    Spectrum from_surroundings(const Bsdf& bsdf, Vec3 wo, const Frame& frame) const;
    /// What shows in direction w in place of what is there.
    Spectrum blurred(Vec3 w) const { return lights_.surroundings.irradiance(w) * inv_pi + options_.ambient; }

    const LocalLights& lights_;
    ShadingOptions options_;
    const LightVisibility* visibility_;
    const RasterKernel& kernel_ = *supported_raster_kernels().front();
};

} // namespace alhazen
