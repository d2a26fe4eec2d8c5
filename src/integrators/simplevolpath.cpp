/// Paths through participating media with nothing clever in them: no light sampling, one wavelength. A
/// yardstick for volpath (Pharr et al. 2023, section 14.2.1).
#include "integrators/integrator.h"
#include "integrators/media_walk.h"
#include "materials/material.h"

namespace alhazen {

namespace {

struct SimpleVolPath final : Integrator {
    int maxdepth = 5;

    static void describe(Fields<SimpleVolPath>& f) {
        f.about("Path tracer for surfaces and participating media without light sampling: a yardstick to "
                "test others with. "
                "Point and distant lights cannot be seen by it.");
        f.field("maxdepth", &SimpleVolPath::maxdepth,
                "bounces and scatterings of a path at most; 0 shows lights only")
            .in(0, 10000);
    }

    bool sees_media() const override { return true; }

    Task<Spectrum> radiance(Ray ray, PathContext& path) const override {
        Spectrum sum = 0;
        const Medium* medium = path.scene.medium_at_camera();
        Vec3 from = ray.o; // where the way began, in a straight line but for borders of media
        path.lambda.terminate_secondary();
        LaneWeights weights(path.lambda, path.samples.next1());
        weights.follow(path.lambda);
        for (int depth = 0; !weights.is_black();) {
            std::optional<Hit> hit = co_await path.closest(ray);
            if (medium) {
                ray.tmax = hit ? hit->t : infinity;
                MediumNumbers numbers(path.samples);
                // What glows is seen at any depth, as by pbrt-v4's.
                MediumCrossing crossing = cross_medium(*medium, ray, true, weights, path, numbers);
                sum += crossing.emitted;
                if (crossing.end == MediumCrossing::End::absorbed) break;
                if (crossing.end == MediumCrossing::End::scattered) {
                    if (depth++ >= maxdepth) break;
                    const PhaseSample next = medium->phase().sample(crossing.wo, path.samples.next2());
                    from = crossing.p;
                    ray = {crossing.p, next.wi, infinity, ray.time};
                    continue;
                }
            }
            if (!hit) {
                for (const Light* light : path.scene.infinite_lights())
                    sum += weights.alone(light->escaped(from, ray.d, path.lambda));
                break;
            }
            if (hit->area_light) sum += weights.alone(hit->area_light->emitted(*hit, path.lambda));
            Vec3 onward = ray.d;
            if (Bsdf* bsdf = hit->material->at(*hit, path.lambda, path.arena)) {
                if (depth++ >= maxdepth) break;
                const Frame frame = hit->shading_frame();
                const float u = path.samples.next1();
                const std::optional<BsdfSample> next =
                    bsdf->sample(frame.to_local(hit->wo), u, path.samples.next2());
                if (!next || next->pdf == 0) break;
                weights.scatter(next->f / next->pdf, next->pdf);
                onward = frame.to_world(next->wi);
                from = hit->p;
            }
            medium = medium_beyond(*hit, onward, medium);
            ray = hit->spawn(onward);
        }
        co_return sum;
    }
};

} // namespace

Kind<Integrator> simplevolpath_integrator() {
    return make_kind<Integrator, SimpleVolPath>("simplevolpath");
}

} // namespace alhazen
