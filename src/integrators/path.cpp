/// The path tracer (Kajiya 1986): light is gathered along random walks from the camera. At each surface one
/// light is sampled (next event estimation) and one direction of the BSDF; where both can find the same
/// light, the two are weighed by the power heuristic (Veach 1997, section 9.2). Walks that carry little end
/// by Russian roulette. The picture: everything surfaces do to light, converging as noise.
#include "integrators/direct_light.h"
#include "integrators/integrator.h"
#include "integrators/weights.h"
#include "materials/material.h"

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

    /// How a path came to where it is: what the light it finds there weighs beside light sampling.
    struct Arrival {
        float pdf = 0;        ///< of the BSDF sample that led here
        bool specular = true; ///< light sampling had no part in finding what this ray finds
        LightReceiver from;

        float weight(float light_pdf) const { return power_heuristic(pdf, light_pdf, specular); }
    };

    Task<Spectrum> radiance(Ray ray, PathContext& path) const override {
        Spectrum sum = 0, throughput = 1;
        float eta_scale = 1; // radiance squeezed by refraction, which Russian roulette must not count as loss
        bool rough_before = false;
        Arrival arrival;

        for (int depth = 0;;) {
            std::optional<Hit> hit = co_await path.closest(ray);
            if (!hit) co_return sum + throughput* escaped_light(ray, arrival, path);
            if (hit->area_light) sum += throughput * emitted_light(*hit, ray, arrival, path);

            Bsdf* bsdf = hit->material->at(*hit, path.lambda, path.arena);
            if (!bsdf) {
                ray = hit->spawn(ray.d);
                continue;
            }
            if (depth++ == maxdepth) co_return sum;
            if (regularize && rough_before) bsdf->regularize();

            Frame frame = hit->shading_frame();
            if (has(bsdf->lobes(), Lobes::diffuse | Lobes::glossy)) {
                if (auto direct = propose_light(*hit, *bsdf, frame, path, LightSampling::beside_bsdf)) {
                    bool visible = co_await path.visible(direct->shadow_ray);
                    if (visible) sum += throughput * direct->value * direct->mis_weight();
                }
            }

            float u = path.samples.next1();
            std::optional<BsdfSample> next = bsdf->sample(frame.to_local(hit->wo), u, path.samples.next2());
            if (!next || next->pdf == 0) co_return sum;
            throughput *= next->f / next->pdf;
            arrival = {next->pdf, has(next->lobes, Lobes::specular), {hit->p, hit->ns}};
            rough_before |= !arrival.specular;
            if (has(next->lobes, Lobes::transmission)) eta_scale *= sqr(next->eta);
            ray = hit->spawn(frame.to_world(next->wi));

            float survival = (throughput * eta_scale).max();
            if (survival < 1 && depth > 1) {
                if (path.samples.next1() >= survival) co_return sum;
                throughput /= survival;
            }
            if (throughput.is_black()) co_return sum;
        }
    }

    static Spectrum escaped_light(const Ray& ray, const Arrival& arrival, const PathContext& path) {
        Spectrum sum = 0;
        for (const Light* light : path.scene.infinite_lights()) {
            float pdf = 0;
            if (!arrival.specular)
                pdf = path.scene.light_probability(arrival.from, light) *
                      light->pdf_escaped_beside_bsdf(arrival.from, ray.d);
            sum += light->escaped(ray.o, ray.d, path.lambda) * arrival.weight(pdf);
        }
        return sum;
    }

    static Spectrum emitted_light(const Hit& hit, const Ray& ray, const Arrival& arrival,
                                  const PathContext& path) {
        Spectrum L = hit.area_light->emitted(hit, path.lambda);
        if (L.is_black() || arrival.specular) return L;
        float pdf = path.scene.light_probability(arrival.from, hit.area_light) *
                    hit.area_light->pdf_hit(arrival.from, hit, ray.d);
        return L * arrival.weight(pdf);
    }
};

} // namespace

Kind<Integrator> path_integrator() {
    return make_kind<Integrator, PathTracer>("path");
}

} // namespace alhazen
