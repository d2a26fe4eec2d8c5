/// The walk of the path tracer, for integrators that are one where nothing fills space.
#pragma once

#include "integrators/integrator.h"
#include "integrators/path_context.h"
#include "integrators/weights.h"

namespace alhazen {

struct PathRules {
    int maxdepth = 5;
    bool regularize = false; ///< widen narrow lobes after the first rough bounce
    float roulettethreshold = 0.25f;

    /// Russian roulette (Arvo and Kirk 1990): the probability with which a path goes on that has met `depth`
    /// surfaces and carries so much of their light. What survives is to be divided by it.
    float survival(float throughput, int depth) const {
        return depth > 1 && throughput < roulettethreshold ? throughput / roulettethreshold : 1;
    }
};

/// An integrator that follows paths by these rules.
struct PathIntegrator : Integrator, PathRules {
    LightSampler lightsampler = LightSampler::bvh;

    std::string light_sampler() const override {
        return FieldType<LightSampler>::choices()[std::size_t(lightsampler)];
    }

  protected:
    template <class T>
    static void describe_path(Fields<T>& f) {
        f.field("maxdepth", &T::maxdepth,
                "bounces (and scatterings, in media) of a path at most; 0 shows lights only")
            .in(0, 10000);
        f.field("regularize", &T::regularize,
                "widen narrow lobes after the first rough bounce: less noise, a little blur");
        f.field("roulettethreshold", &T::roulettethreshold,
                "paths that carry less of the light than this, after two bounces, go on by chance only "
                "(Russian roulette); 1 is what pbrt-v4 does, 0 ends no path early; the mean is the same")
            .in(0, 1);
        f.field("lightsampler", &T::lightsampler, "how the light to sample is chosen");
    }
};

/// The radiance arriving against the ray, from surfaces: one light and one direction of the BSDF are sampled
/// at each (see path.cpp).
Task<Spectrum> trace_path(PathRules rules, Ray ray, PathContext& path);

} // namespace alhazen
