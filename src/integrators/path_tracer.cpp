#include "integrators/path_tracer.h"

#include "integrators/arrival.h"
#include "integrators/direct_light.h"
#include "integrators/subsurface_walk.h"
#include "materials/material.h"

namespace alhazen {

Task<Spectrum> trace_path(PathRules rules, Ray ray, PathContext& path) {
    Spectrum sum = 0, throughput = 1;
    float eta_scale = 1; // radiance squeezed by refraction, which Russian roulette must not count as loss
    bool rough_before = false;
    Arrival arrival;
    arrival.from.p = ray.o;

    for (int depth = 0;;) {
        std::optional<Hit> hit = co_await path.closest(ray);
        if (!hit) co_return sum + throughput* escaped_light(ray, arrival, path);
        if (hit->area_light) sum += throughput * emitted_light(*hit, ray, arrival, path);

        Bsdf* bsdf = hit->material->at(*hit, path.lambda, path.arena);
        if (!bsdf) {
            ray = hit->spawn(ray.d);
            continue;
        }
        if (depth++ == rules.maxdepth) co_return sum;
        if (rules.regularize && rough_before) bsdf->regularize();

        const Bsdf* scattering = bsdf;
        std::optional<BsdfSample> next;
        Frame frame;
        for (;;) {
            frame = hit->shading_frame();
            if (has(scattering->lobes(), Lobes::diffuse | Lobes::glossy)) {
                if (std::optional<DirectLight> direct =
                        propose_light(*hit, *scattering, frame, path, LightSampling::beside_bsdf)) {
                    bool visible = co_await path.visible(direct->shadow_ray);
                    if (visible) sum += throughput * direct->value * direct->mis_weight();
                }
            }
            float u = path.samples.next1();
            next = scattering->sample(frame.to_local(hit->wo), u, path.samples.next2());
            if (!next || next->pdf == 0) co_return sum;
            throughput *= next->f / next->pdf;
            const Bssrdf* matter = matter_entered(*hit, *next, path);
            if (!matter) break;
            // Light that is squeezed on its way in spreads again on its way out: the two cancel out.
            std::optional<SubsurfaceExit> exit = co_await leave_matter(*hit, *matter, path);
            if (!exit) co_return sum;
            throughput *= exit->weight * sqr(next->eta);
            hit = exit->hit;
            scattering = &matter->exit_bsdf;
        }
        arrival = {next->pdf, has(next->lobes, Lobes::specular), {hit->p, hit->ns}};
        rough_before |= !arrival.specular;
        if (has(next->lobes, Lobes::transmission)) eta_scale *= sqr(next->eta);
        ray = hit->spawn(frame.to_world(next->wi));

        const float survival = rules.survival((throughput * eta_scale).max(), depth);
        if (survival < 1) {
            if (path.samples.next1() >= survival) co_return sum;
            throughput /= survival;
        }
        if (throughput.is_black()) co_return sum;
    }
}

} // namespace alhazen
