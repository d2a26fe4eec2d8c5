#include "integrators/media_walk.h"

#include "materials/material.h"

namespace alhazen {

namespace {

Collisions collisions_of(const Medium& medium, const Ray& ray, int hero, PathContext& path,
                         MediumNumbers& numbers) {
    const MediumNumbers::Start start = numbers.next();
    return Collisions(medium, ray, path.lambda, path.colors_of(medium), hero, start.u, Rng(start.key));
}

// Through one medium towards a light; where hardly any of it is left, three of four such rays are given up.
void weaken_by(const Medium& medium, const Ray& ray, LaneWeights& weights, PathContext& path,
               MediumNumbers& numbers) {
    constexpr float hardly_any = 0.05f, given_up = 0.75f;
    const float whole = weights.shadow_transmittance();
    Collisions collisions = collisions_of(medium, ray, weights.hero(), path, numbers);
    while (const auto collision = collisions.next()) {
        weights.weaken(*collision);
        if (weights.is_black()) return;
        if (weights.shadow_transmittance() >= hardly_any * whole) continue;
        if (collisions.uniform() < given_up) return weights.block();
        weights.scale(1 / (1 - given_up));
    }
    weights.pass(collisions.transmittance());
}

} // namespace

MediumCrossing cross_medium(const Medium& medium, const Ray& ray, bool counts_emission, LaneWeights& weights,
                            PathContext& path, MediumNumbers& numbers) {
    using End = MediumCrossing::End;
    MediumCrossing crossing;
    const int hero = weights.hero();
    const bool emits = counts_emission && medium.is_emissive();
    Collisions collisions = collisions_of(medium, ray, hero, path, numbers);
    while (const auto collision = collisions.next()) {
        if (emits && !collision->at.sigma_a.is_black()) crossing.emitted += weights.emitted(*collision);
        // What the collision was is drawn at the hero's wavelength.
        const float absorbed = collision->at.sigma_a[hero], scattered = collision->at.sigma_s[hero];
        const float u = collisions.uniform() * collision->sigma_maj[hero];
        if (u < absorbed) {
            crossing.end = End::absorbed;
            return crossing;
        }
        if (u < absorbed + scattered) {
            crossing.end = End::scattered;
            crossing.p = ray.at(collision->t);
            crossing.wo = normalize(-ray.d);
            weights.collide(*collision);
            return crossing;
        }
        // Rounding may leave nothing of what is neither.
        if (collision->sigma_n()[hero] > 0) weights.pass_null(*collision);
    }
    weights.pass(collisions.transmittance());
    return crossing;
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
        chosen->light->sample(receiver, path.pair_for(*chosen->light), path.lambda);
    if (!light || !(light->pdf > 0) || light->L.is_black()) return std::nullopt;

    DirectLight direct;
    const float phase = medium.phase().eval(at.wo, light->wi);
    direct.light_pdf = chosen->probability * light->pdf;
    direct.bsdf_pdf = phase;
    direct.is_delta = chosen->light->is_delta();
    direct.value = light->L * (phase / direct.light_pdf);
    const Vec3 to = offset_origin(light->p, light->p_error, light->ng, at.p - light->p);
    direct.shadow_ray = {at.p, to - at.p, 1 - shadow_epsilon, time};
    return direct;
}

Task<LaneWeights> shadow_weights(Ray ray, const Medium* medium, LaneWeights weights, PathContext& path,
                                 MediumNumbers numbers) {
    weights.begin_shadow();
    const Vec3 target = ray.o + ray.d;
    for (;;) {
        const std::optional<Hit> hit = co_await path.closest(ray);
        if (hit && !hit->material->choose(*hit)->is_interface()) {
            weights.block();
            co_return weights;
        }
        if (medium) {
            Ray part = ray;
            // Without a border in between, on to the light itself.
            part.tmax = hit ? hit->t : 1;
            weaken_by(*medium, part, weights, path, numbers);
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
