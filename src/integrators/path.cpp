/// The path tracer (Kajiya 1986): light is gathered along random walks from the camera. At each surface one
/// light is sampled (next event estimation) and one direction of the BSDF; where both can find the same
/// light, the two are weighed by the power heuristic (Veach 1997, section 9.2). Walks that carry little end
/// by Russian roulette. The picture: everything surfaces do to light, converging as noise.
#include "integrators/path_tracer.h"

namespace alhazen {

namespace {

struct PathTracer final : PathIntegrator {
    static void describe(Fields<PathTracer>& f) {
        f.about(
            "Unidirectional path tracer with next event estimation, multiple importance sampling and Russian "
            "roulette.");
        describe_path(f);
    }

    bool sees_subsurface() const override { return true; }

    Task<Spectrum> radiance(Ray ray, PathContext& path) const override {
        return trace_path(*this, ray, path);
    }
};

} // namespace

Kind<Integrator> path_integrator() {
    return make_kind<Integrator, PathTracer>("path");
}

} // namespace alhazen
