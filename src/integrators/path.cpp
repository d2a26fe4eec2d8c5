/// The path tracer (Kajiya 1986): light is gathered along random walks from the camera. At each surface one
/// light is sampled (next event estimation) and one direction of the BSDF; where both can find the same
/// light, the two are weighed by the power heuristic (Veach 1997, section 9.2). Walks that carry little end
/// by Russian roulette. The picture: everything surfaces do to light, converging as noise.
#include "integrators/integrator.h"
#include "integrators/path_tracer.h"
#include "integrators/weights.h"

namespace alhazen {

namespace {

struct PathTracer final : Integrator {
    int maxdepth = 5;
    bool regularize = false;
    LightSampler lightsampler = LightSampler::bvh;

    static void describe(Fields<PathTracer>& f) {
        f.about(
            "Unidirectional path tracer with next event estimation, multiple importance sampling and Russian "
            "roulette.");
        f.field("maxdepth", &PathTracer::maxdepth, "bounces of a path at most; 0 shows lights only")
            .in(0, 10000);
        f.field("regularize", &PathTracer::regularize,
                "widen narrow lobes after the first rough bounce: less noise, a little blur");
        f.field("lightsampler", &PathTracer::lightsampler, "how the light to sample is chosen");
    }

    std::string light_sampler() const override {
        return FieldType<LightSampler>::choices()[std::size_t(lightsampler)];
    }

    bool sees_subsurface() const override { return true; }

    Task<Spectrum> radiance(Ray ray, PathContext& path) const override {
        return trace_path({maxdepth, regularize}, ray, path);
    }
};

} // namespace

Kind<Integrator> path_integrator() {
    return make_kind<Integrator, PathTracer>("path");
}

} // namespace alhazen
