#include "integrators/media_walk.h"

#include "materials/material.h"

namespace alhazen {

namespace {

Collisions collisions_of(const Medium& medium, const Ray& ray, int hero, PathContext& path,
                         MediumNumbers& numbers, const ClearCells* clear) {
    const MediumNumbers::Start start = numbers.next();
    return Collisions(medium, ray, path.lambda, path.colors_of(medium), hero, start.u, Rng(start.key), clear);
}

// The same in place: it is large.
void begin(std::optional<Collisions>& collisions, const Medium& medium, const Ray& ray, int hero,
           PathContext& path, MediumNumbers& numbers, const ClearCells* clear) {
    const MediumNumbers::Start start = numbers.next();
    collisions.emplace(medium, ray, path.lambda, path.colors_of(medium), hero, start.u, Rng(start.key),
                       clear);
}

// Through one medium towards a light; where hardly any of the whole is left, three of four such rays are
// given up. False when it first has to be known which surface the ray meets.
bool weaken_by(Collisions& collisions, float whole, LaneWeights& weights) {
    constexpr float hardly_any = 0.05f, given_up = 0.75f;
    while (const auto collision = collisions.next()) {
        weights.weaken(*collision);
        if (weights.is_black()) return true;
        if (weights.shadow_transmittance() >= hardly_any * whole) continue;
        if (collisions.uniform() < given_up) {
            weights.block();
            return true;
        }
        weights.scale(1 / (1 - given_up));
    }
    if (collisions.needs_surface()) return false;
    weights.weaken(collisions.transmittance());
    return true;
}

// Of the ray's first t lengths of its direction, in a homogeneous medium.
Spectrum transmittance_of(const Medium& medium, const Ray& ray, float t, PathContext& path) {
    const float passed = t * length(ray.d);
    return map(path.colors_of(medium).sigma_t(), [&](float sigma) { return std::exp(-sigma * passed); });
}

} // namespace

MediumWalk::MediumWalk(const Medium& medium, const Ray& ray, bool counts_emission, LaneWeights& weights,
                       PathContext& path, MediumNumbers& numbers, const ClearCells* clear)
    : ray_(ray), weights_(weights),
      collisions_(collisions_of(medium, ray, weights.hero(), path, numbers, clear)),
      emits_(counts_emission && medium.is_emissive()), is_homogeneous_(medium.is_homogeneous()),
      end_(ray.tmax) {}

bool MediumWalk::go_on() {
    while (const auto collision = collisions_.next())
        if (collide(*collision)) return true;
    if (collisions_.needs_surface()) return false;
    // Light sampling would have passed with certainty through what is the same everywhere; see
    // shadow_weights.
    weights_.pass(collisions_.transmittance(), is_homogeneous_ && end_ < infinity
                                                   ? Spectrum(1 / collisions_.hero_transmittance())
                                                   : collisions_.transmittance());
    return true;
}

bool MediumWalk::collide(const Collision& collision) {
    using End = MediumCrossing::End;
    const int hero = weights_.hero();
    if (emits_ && !collision.at.sigma_a.is_black()) crossing_.emitted += weights_.emitted(collision);
    // What the collision was is drawn at the hero's wavelength.
    const float absorbed = collision.at.sigma_a[hero], scattered = collision.at.sigma_s[hero];
    const float u = collisions_.uniform() * collision.sigma_maj[hero];
    if (u < absorbed) {
        crossing_.end = End::absorbed;
        return true;
    }
    if (u < absorbed + scattered) {
        crossing_.end = End::scattered;
        crossing_.p = ray_.at(collision.t);
        crossing_.wo = normalize(-ray_.d);
        weights_.collide(collision);
        return true;
    }
    // Rounding may leave nothing of what is neither.
    if (collision.sigma_n()[hero] > 0) weights_.pass_null(collision);
    return false;
}

MediumCrossing cross_medium(const Medium& medium, const Ray& ray, bool counts_emission, LaneWeights& weights,
                            PathContext& path, MediumNumbers& numbers) {
    MediumWalk walk(medium, ray, counts_emission, weights, path, numbers, nullptr);
    walk.go_on();
    return walk.crossing();
}

std::optional<DirectLight> propose_light_in_medium(const MediumCrossing& at, const Medium& medium, float time,
                                                   PathContext& path) {
    const LightReceiver receiver{at.p, {}};
    std::optional<ChosenLight> chosen = path.scene.choose_light(receiver, path.samples.next1());
    if (!chosen) {
        path.samples.skip(2);
        return std::nullopt;
    }
    std::optional<LightSample> light =
        chosen->light->sample_beside_bsdf(receiver, path.pair_for(*chosen->light), path.lambda);
    if (!light || !(light->pdf > 0) || light->L.is_black()) return std::nullopt;

    DirectLight direct;
    const float phase = medium.phase().eval(at.wo, light->wi);
    direct.light_pdf = chosen->probability * light->pdf;
    direct.bsdf_pdf = phase;
    direct.is_delta = chosen->light->is_delta();
    direct.is_sky = chosen->light->is_infinite() && !direct.is_delta;
    direct.value = light->L * (phase / direct.light_pdf);
    const Vec3 to = offset_origin(light->p, light->p_error, light->ng, at.p - light->p);
    direct.shadow_ray = {at.p, to - at.p, 1 - shadow_epsilon, time};
    return direct;
}

Task<LaneWeights> shadow_weights(Ray ray, const Medium* medium, bool is_sky, LaneWeights weights,
                                 PathContext& path, MediumNumbers numbers) {
    weights.begin_shadow();
    const Vec3 target = ray.o + ray.d;
    for (;;) {
        std::optional<Collisions> collisions;
        const float whole = weights.shadow_transmittance();
        if (medium && !medium->is_homogeneous()) {
            // Without a border in between, on to the light itself.
            Ray part = ray;
            part.tmax = 1;
            begin(collisions, *medium, part, weights.hero(), path, numbers, &path.scene.clear_cells(*medium));
            // What the medium alone has decided needs no ray.
            if (weaken_by(*collisions, whole, weights)) co_return weights;
        }
        const std::optional<Hit> hit = co_await path.closest_before_light(ray);
        if (hit && !hit->material->choose(*hit)->is_interface()) {
            weights.block();
            co_return weights;
        }
        const float t = hit ? hit->t : 1;
        if (collisions) {
            collisions->meet(t);
            weaken_by(*collisions, whole, weights);
        } else if (medium && (hit || !is_sky)) {
            weights.weaken_surely(transmittance_of(*medium, ray, t, path));
        } else if (medium) {
            ray.tmax = 1;
            begin(collisions, *medium, ray, weights.hero(), path, numbers, nullptr);
            weaken_by(*collisions, whole, weights);
        }
        if (!hit || weights.is_black()) co_return weights;
        medium = medium_beyond(*hit, ray.d, medium);
        ray.o = offset_origin(hit->p, hit->p_error, hit->ng, target - hit->p);
        ray.d = target - ray.o;
    }
}

Task<const Medium*> medium_at(Ray ray, Vec3 camera, PathContext& path) {
    for (;;) {
        ray.d = camera - ray.o;
        ray.tmax = 1;
        const std::optional<Hit> hit = co_await path.closest(ray);
        if (!hit) co_return path.scene.medium_at_camera();
        if (hit->media) co_return medium_beyond(*hit, -ray.d, nullptr);
        ray.o = offset_origin(hit->p, hit->p_error, hit->ng, ray.d);
    }
}

} // namespace alhazen
