/// Integrators: the light that arrives along a camera ray.
#pragma once

#include "describe/kind.h"
#include "integrators/path_context.h"
#include "integrators/task.h"

namespace alhazen {

struct Integrator {
    static constexpr std::string_view family_name = "integrator";
    virtual ~Integrator() = default;

    /// The radiance arriving against the ray (one sample of it), in path's wavelengths or RGB.
    virtual Task<Spectrum> radiance(Ray ray, PathContext& path) const = 0;

    /// True for models that are defined in linear RGB.
    virtual bool works_in_rgb() const { return false; }
    /// True when a picture of one sample a pixel goes through the pixels' centres.
    virtual bool centres_single_samples() const { return false; }
    /// How lights are chosen: one of light_chooser_names().
    virtual std::string light_sampler() const { return "bvh"; }
};

const KindList<Integrator>& integrator_kinds();

} // namespace alhazen
