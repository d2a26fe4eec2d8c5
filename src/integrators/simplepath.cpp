/// A path tracer with nothing clever in it: light sampling and BSDF sampling can each be turned off, and no
/// multiple importance sampling mends what either is bad at. Slow, short, and the yardstick for the others
/// (Pharr, Jakob and Humphreys 2023, section 13.2).
#include "integrators/direct_light.h"
#include "integrators/integrator.h"
#include "materials/material.h"
#include "math/warp.h"

namespace alhazen {

namespace {

struct SimplePath final : Integrator {
    int maxdepth = 5;
    bool samplelights = true;
    bool samplebsdf = true;

    static void describe(Fields<SimplePath>& f) {
        f.about("Path tracer without multiple importance sampling: a yardstick to test others with.");
        f.field("maxdepth", &SimplePath::maxdepth, "bounces of a path at most; 0 shows lights only")
            .in(0, 10000);
        f.field("samplelights", &SimplePath::samplelights, "sample a light at each surface");
        f.field("samplebsdf", &SimplePath::samplebsdf, "draw directions from the BSDF, not uniformly");
    }

    std::string light_sampler() const override { return "uniform"; }

    Task<Spectrum> radiance(Ray ray, PathContext& path) const override {
        Spectrum sum = 0, throughput = 1;
        bool specular = true;
        Vec3 from = ray.o; // where the way began, in a straight line but for borders of media
        for (int depth = 0; !throughput.is_black();) {
            std::optional<Hit> hit = co_await path.closest(ray);
            bool count_emission = !samplelights || specular;
            if (!hit) {
                if (count_emission)
                    for (const Light* light : path.scene.infinite_lights())
                        sum += throughput * light->escaped(from, ray.d, path.lambda);
                break;
            }
            if (hit->area_light && count_emission)
                sum += throughput * hit->area_light->emitted(*hit, path.lambda);
            Bsdf* bsdf = hit->material->at(*hit, path.lambda, path.arena);
            if (!bsdf) {
                ray = hit->spawn(ray.d);
                continue;
            }
            if (depth++ == maxdepth) break;
            Frame frame = hit->shading_frame();
            if (samplelights) {
                if (std::optional<DirectLight> direct = propose_light(*hit, *bsdf, frame, path)) {
                    bool visible = co_await path.visible(direct->shadow_ray);
                    if (visible) sum += throughput * direct->value;
                }
            }
            std::optional<BsdfSample> next = sample_direction(*bsdf, frame.to_local(hit->wo), path);
            if (!next || next->pdf == 0) break;
            throughput *= next->f / next->pdf;
            specular = has(next->lobes, Lobes::specular);
            from = hit->p;
            ray = hit->spawn(frame.to_world(next->wi));
        }
        co_return sum;
    }

    std::optional<BsdfSample> sample_direction(const Bsdf& bsdf, Vec3 wo, PathContext& path) const {
        float u = path.samples.next1();
        Vec2 u2 = path.samples.next2();
        // Uniform directions cannot meet a delta distribution.
        if (samplebsdf || !has(bsdf.lobes(), Lobes::diffuse | Lobes::glossy)) return bsdf.sample(wo, u, u2);
        BsdfSample s;
        bool both_sides = has(bsdf.lobes(), Lobes::transmission) && has(bsdf.lobes(), Lobes::reflection);
        s.wi = both_sides ? sample_sphere(u2) : sample_hemisphere(u2);
        s.pdf = both_sides ? sphere_pdf() : hemisphere_pdf();
        if (!both_sides && has(bsdf.lobes(), Lobes::reflection) == (wo.z < 0)) s.wi.z = -s.wi.z;
        s.f = bsdf.eval(wo, s.wi).f;
        return s;
    }
};

} // namespace

Kind<Integrator> simplepath_integrator() {
    return make_kind<Integrator, SimplePath>("simplepath");
}

} // namespace alhazen
