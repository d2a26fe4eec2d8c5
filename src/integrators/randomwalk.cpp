/// The shortest unbiased integrator: a walk of uniformly random directions that counts the light it runs into
/// (Pharr, Jakob and Humphreys 2023, section 1.3.6). Point lights and perfect mirrors it cannot see.
#include "integrators/integrator.h"
#include "materials/material.h"
#include "math/warp.h"

namespace alhazen {

namespace {

struct RandomWalk final : Integrator {
    int maxdepth = 5;

    static void describe(Fields<RandomWalk>& f) {
        f.about("Follows uniformly random directions and counts the light met on the way. Sees no point "
                "lights and "
                "no perfect mirrors; very noisy.");
        f.field("maxdepth", &RandomWalk::maxdepth, "bounces of a path at most; 0 shows lights only")
            .in(0, 10000);
    }

    Task<Spectrum> radiance(Ray ray, PathContext& path) const override {
        Spectrum sum = 0, throughput = 1;
        Vec3 from = ray.o; // where the way began, in a straight line but for borders of media
        for (int depth = 0; !throughput.is_black();) {
            std::optional<Hit> hit = co_await path.closest(ray);
            if (!hit) {
                for (const Light* light : path.scene.infinite_lights())
                    sum += throughput * light->escaped(from, ray.d, path.lambda);
                break;
            }
            if (hit->area_light) sum += throughput * hit->area_light->emitted(*hit, path.lambda);
            Bsdf* bsdf = hit->material->at(*hit, path.lambda, path.arena);
            if (!bsdf) {
                ray = hit->spawn(ray.d);
                continue;
            }
            if (depth++ == maxdepth) break;
            Frame frame = hit->shading_frame();
            Vec3 wi = sample_sphere(path.samples.next2());
            throughput *= bsdf->eval(frame.to_local(hit->wo), wi).f / sphere_pdf();
            from = hit->p;
            ray = hit->spawn(frame.to_world(wi));
        }
        co_return sum;
    }
};

} // namespace

Kind<Integrator> randomwalk_integrator() {
    return make_kind<Integrator, RandomWalk>("randomwalk");
}

} // namespace alhazen
