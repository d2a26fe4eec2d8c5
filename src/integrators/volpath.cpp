/// The path tracer through participating media (Pharr et al. 2023, section 14.2). Media are crossed by
/// tentative collisions, each of which turns out to be an absorption, a scattering, or nothing. The
/// wavelengths of a path share one walk, placed by one of them; each is weighed by the mean density that all
/// of them have for the walk (Miller, Georgiev and Jarosz 2019). Where a scene has no media, it is the path
/// tracer.
#include "integrators/integrator.h"
#include "integrators/media_walk.h"
#include "integrators/path_tracer.h"
#include "integrators/subsurface_walk.h"
#include "integrators/weights.h"
#include "materials/material.h"

namespace alhazen {

namespace {

struct VolPath final : PathIntegrator {
    static void describe(Fields<VolPath>& f) {
        f.about("Path tracer for surfaces and participating media, with next event estimation, multiple "
                "importance sampling over techniques and wavelengths, and Russian roulette.");
        describe_path(f);
    }

    bool sees_media() const override { return true; }
    bool sees_subsurface() const override { return true; }

    Task<Spectrum> radiance(Ray ray, PathContext& path) const override {
        if (!path.scene.has_media()) return trace_path(*this, ray, path);
        return trace_through_media(ray, path);
    }

  private:
    /// Where a path is, and what it is worth there.
    struct Walk {
        Ray ray;
        const Medium* medium = nullptr;
        LaneWeights weights;
        int depth = 0;
        float eta_scale = 1; // radiance squeezed by refraction, which Russian roulette must not count as loss
        bool specular = true; ///< light sampling had no part in finding what the ray finds
        bool rough_before = false;
        LightReceiver from;

        /// Light that the ray has met, which light sampling would have chosen with a density.
        Spectrum found(Spectrum L, float light_pdf) const {
            return specular ? weights.alone(L) : weights.beside_light(L, light_pdf);
        }
    };

    Task<Spectrum> trace_through_media(Ray ray, PathContext& path) const {
        Spectrum sum = 0;
        Walk walk;
        walk.ray = ray;
        walk.from.p = ray.o;
        walk.medium = path.scene.medium_at_camera();
        walk.weights = LaneWeights(path.lambda, path.samples.next1());
        const Arena::Mark mark = path.arena.mark();
        for (;;) {
            // What one scattering needed, the next does not.
            path.arena.rewind(mark);
            std::optional<Hit> hit;
            if (!walk.medium) {
                hit = co_await path.closest(walk.ray);
            } else {
                MediumNumbers numbers(path.samples);
                MediumWalk through(*walk.medium, walk.ray, walk.depth < maxdepth, walk.weights, path, numbers,
                                   &path.scene.clear_cells(*walk.medium));
                // Deep in a medium, most of what happens takes no ray through the scene. The camera's first
                // counts.
                if (walk.depth == 0 || !through.go_on()) {
                    hit = co_await path.closest(walk.ray);
                    through.meet(hit ? hit->t : infinity);
                    through.go_on();
                }
                const MediumCrossing& crossing = through.crossing();
                sum += crossing.emitted;
                if (crossing.end == MediumCrossing::End::absorbed) co_return sum;
                if (crossing.end == MediumCrossing::End::scattered) {
                    if (walk.depth++ >= maxdepth) co_return sum;
                    sum += co_await direct_light_in_medium(crossing, walk, path);
                    scatter_in_medium(crossing, walk, path);
                    if (!survives(walk, path)) co_return sum;
                    continue;
                }
            }
            if (!hit) co_return sum + escaped_light(walk, path);
            if (hit->area_light) sum += emitted_light(*hit, walk, path);

            Bsdf* bsdf = hit->material->at(*hit, path.lambda, path.arena);
            walk.weights.follow(path.lambda);
            if (!bsdf) {
                walk.medium = medium_beyond(*hit, walk.ray.d, walk.medium);
                walk.ray = hit->spawn(walk.ray.d);
                continue;
            }
            if (walk.depth++ >= maxdepth) co_return sum;
            if (regularize && walk.rough_before) bsdf->regularize();
            sum += co_await scatter_at_surface(*hit, *bsdf, walk, path);
            if (!survives(walk, path)) co_return sum;
        }
    }

    static Spectrum escaped_light(const Walk& walk, const PathContext& path) {
        Spectrum sum = 0;
        for (const Light* light : path.scene.infinite_lights()) {
            float pdf = 0;
            if (!walk.specular)
                pdf = path.scene.light_probability(walk.from, light) *
                      light->pdf_escaped_beside_bsdf(walk.from, walk.ray.d);
            sum += walk.found(light->escaped(walk.from.p, walk.ray.d, path.lambda), pdf);
        }
        return sum;
    }

    static Spectrum emitted_light(const Hit& hit, const Walk& walk, const PathContext& path) {
        const Spectrum L = hit.area_light->emitted(hit, path.lambda);
        if (L.is_black()) return 0;
        float pdf = 0;
        if (!walk.specular)
            pdf = path.scene.light_probability(walk.from, hit.area_light) *
                  hit.area_light->pdf_hit(walk.from, hit, walk.ray.d);
        return walk.found(L, pdf);
    }

    static Task<Spectrum> direct_light_at_surface(const Hit& hit, const Bsdf& bsdf, const Walk& walk,
                                                  PathContext& path) {
        const std::optional<DirectLight> direct =
            propose_light(hit, bsdf, hit.shading_frame(), path, LightSampling::beside_bsdf);
        if (!direct) co_return 0;
        const LaneWeights weights =
            co_await shadow_weights(direct->shadow_ray, medium_beyond(hit, direct->shadow_ray.d, walk.medium),
                                    direct->is_sky, walk.weights, path, MediumNumbers(path.samples));
        co_return weights.from_light(direct->value, direct->light_pdf,
                                     direct->is_delta ? 0 : direct->bsdf_pdf);
    }

    static Task<Spectrum> direct_light_in_medium(const MediumCrossing& crossing, const Walk& walk,
                                                 PathContext& path) {
        const std::optional<DirectLight> direct =
            propose_light_in_medium(crossing, *walk.medium, walk.ray.time, path);
        if (!direct) co_return 0;
        const LaneWeights weights = co_await shadow_weights(direct->shadow_ray, walk.medium, direct->is_sky,
                                                            walk.weights, path, MediumNumbers(path.samples));
        co_return weights.from_light(direct->value, direct->light_pdf,
                                     direct->is_delta ? 0 : direct->bsdf_pdf);
    }

    static void scatter_in_medium(const MediumCrossing& crossing, Walk& walk, PathContext& path) {
        const PhaseSample next = walk.medium->phase().sample(crossing.wo, path.samples.next2());
        walk.weights.scatter(1, next.pdf);
        walk.from = {crossing.p, {}};
        walk.specular = false;
        walk.rough_before = true;
        walk.ray = {crossing.p, next.wi, infinity, walk.ray.time};
    }

    /// Gives the light that comes straight from a light source; what is left of the walk may be nothing.
    static Task<Spectrum> scatter_at_surface(Hit hit, const Bsdf& bsdf, Walk& walk, PathContext& path) {
        Spectrum sum = 0;
        const Bsdf* scattering = &bsdf;
        for (;;) {
            const Frame frame = hit.shading_frame();
            if (has(scattering->lobes(), Lobes::diffuse | Lobes::glossy))
                sum += co_await direct_light_at_surface(hit, *scattering, walk, path);
            const float u = path.samples.next1();
            const std::optional<BsdfSample> next =
                scattering->sample(frame.to_local(hit.wo), u, path.samples.next2());
            if (!next || next->pdf == 0) break;
            walk.weights.scatter(next->f / next->pdf, next->pdf);
            const Bssrdf* matter = matter_entered(hit, *next, path);
            if (!matter) {
                go_on(hit, *next, frame.to_world(next->wi), walk);
                co_return sum;
            }
            // Light that is squeezed on its way in spreads again on its way out: the two cancel out.
            const std::optional<SubsurfaceExit> exit = co_await leave_matter(hit, *matter, path);
            if (!exit) break;
            walk.weights.scatter(exit->weight * sqr(next->eta), 1);
            hit = exit->hit;
            scattering = &matter->exit_bsdf;
        }
        walk.weights.scale(0);
        co_return sum;
    }

    static void go_on(const Hit& hit, const BsdfSample& next, Vec3 wi, Walk& walk) {
        walk.from = {hit.p, hit.ns};
        walk.specular = has(next.lobes, Lobes::specular);
        walk.rough_before |= !walk.specular;
        if (has(next.lobes, Lobes::transmission)) walk.eta_scale *= sqr(next.eta);
        walk.medium = medium_beyond(hit, wi, walk.medium);
        walk.ray = hit.spawn(wi);
    }

    bool survives(Walk& walk, PathContext& path) const {
        const float carried = walk.weights.throughput() * walk.eta_scale;
        const float chance = survival(carried, walk.depth);
        if (chance < 1) {
            if (path.samples.next1() >= chance) return false;
            walk.weights.scale(1 / chance);
        }
        return carried > 0;
    }
};

} // namespace

Kind<Integrator> volpath_integrator() {
    return make_kind<Integrator, VolPath>("volpath");
}

} // namespace alhazen
