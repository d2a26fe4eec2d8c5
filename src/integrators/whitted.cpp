/// The classic ray tracer (Whitted 1980), for every shape. A ray is followed to what it hits; what the eye
/// sees there is the light that arrives directly (Phong 1975), plus what a mirror shows, plus what shines
/// through:
///
///     trace(ray, depth) = (1 - kr) local + kr trace(mirrored, depth - 1) + kt trace(refracted, depth - 1)
///
/// The picture: hard shadows, sharp reflections, glass; nothing soft. Values are linear RGB.
///
/// Each surface may send out two rays, and a scene made for path tracing may ask for a depth of sixty; so
/// deep in the tree only rays are followed that may still be seen (Hall and Greenberg 1983, "A Testbed for
/// Realistic Image Synthesis").
#include <cmath>

#include "integrators/integrator.h"
#include "materials/material.h"

namespace alhazen {

namespace {

/// D - 2 (D.N) N: the direction of a ray that came along d and left a mirror with normal n.
Vec3 reflect_ray(Vec3 d, Vec3 n) {
    return d - n * (2 * dot(d, n));
}

/// Snell's law, eta1 sin(theta1) = eta2 sin(theta2), for a ray along d meeting a surface whose normal n faces
/// it; eta = eta1 / eta2. On total internal reflection there is no refracted ray, and the mirrored one takes
/// its place.
Vec3 refract_ray(Vec3 d, Vec3 n, float eta) {
    float cos1 = -dot(d, n);
    float sin2_squared = eta * eta * (1 - cos1 * cos1);
    if (sin2_squared > 1) return reflect_ray(d, n);
    return normalize(d * eta + n * (eta * cos1 - std::sqrt(1 - sin2_squared)));
}

struct Whitted final : Integrator {
    int maxdepth = 5;
    bool shadows = true;
    UnboundedSpectrum ambient{0.1f};

    static void describe(Fields<Whitted>& f) {
        f.about(
            "Whitted's ray tracer: local light by each material's formula, sharp shadows, mirrors and glass. "
            "Works in linear RGB.");
        f.field(
             "maxdepth", &Whitted::maxdepth,
             "how many surfaces a ray may meet, the first one included; behind eight of them only rays are "
             "followed that count for more than a thousandth")
            .in(0, 100);
        f.field("shadows", &Whitted::shadows, "whether objects block light");
        f.field("ambient", &Whitted::ambient, "light that comes from everywhere, Ia").in(0, 1e30);
    }

    bool works_in_rgb() const override { return true; }
    std::unique_ptr<RayBundles> bundles(const Scene& scene) const override {
        return whitted_bundles(scene, {maxdepth, shadows, ambient.eval(Wavelengths::rgb())});
    }
    bool centres_single_samples() const override { return true; }
    Task<Spectrum> radiance(Ray ray, PathContext& path) const override {
        return trace_ray(ray, maxdepth, 1, path);
    }

    /// The nearest surface along the ray. For a sphere that is the smaller positive root of a quadratic: see
    /// intersect_ray_sphere in shapes/ball.h.
    static auto intersect_scene(const Ray& ray, PathContext& path) { return path.closest(ray); }

    /// weight: what its light is multiplied by on the way to the eye.
    Task<Spectrum> trace_ray(Ray ray, int depth, Spectrum weight, PathContext& path) const {
        if (depth == 0 || (maxdepth - depth >= whitted_whole_depth && weight.max() < whitted_least_weight))
            co_return Spectrum(0);
        std::optional<Hit> hit = co_await intersect_scene(ray, path);
        if (!hit) co_return background(ray, path);

        Bsdf* bsdf = hit->material->at(*hit, path.lambda, path.arena);
        if (!bsdf) // only a border of media
            co_return co_await trace_ray(hit->spawn(ray.d), depth - 1, weight, path);

        Vec3 n = face_forward(hit->ns, hit->wo);
        Frame frame = hit->shading_frame();
        WhittedTerms k = bsdf->whitted(frame.to_local(hit->wo));
        Spectrum local = co_await compute_lighting(*hit, frame, *bsdf, k.ambient, path);
        Spectrum sum = (Spectrum(1) - k.mirror) * local;
        // What one branch of the tree needs is free for the next.
        const Arena::Mark mark = path.arena.mark();
        if (!k.mirror.is_black()) {
            Ray mirrored = hit->spawn(reflect_ray(ray.d, n));
            sum += k.mirror * co_await trace_ray(mirrored, depth - 1, weight * k.mirror, path);
            path.arena.rewind(mark);
        }
        if (!k.refract.is_black()) {
            bool entering = dot(ray.d, hit->ns) < 0;
            Ray refracted = hit->spawn(refract_ray(ray.d, n, entering ? 1 / k.eta : k.eta));
            sum += k.refract * co_await trace_ray(refracted, depth - 1, weight * k.refract, path);
            path.arena.rewind(mark);
        }
        co_return sum;
    }

    /// ka Ia + sum over lights [kd max(0, L.N) + ks max(0, R.V)^n] Il for phong materials, the BSDF's value
    /// for others; a light behind any object adds nothing. Area lights and environments give one sample each.
    Task<Spectrum> compute_lighting(const Hit& hit, const Frame& frame, const Bsdf& bsdf, Spectrum ka,
                                    PathContext& path) const {
        Vec3 wo = frame.to_local(hit.wo);
        Spectrum sum = ka * ambient.eval(path.lambda);
        if (hit.area_light) sum += hit.area_light->emitted(hit, path.lambda);
        for (const Light* light : path.scene.lights()) {
            auto arriving = light->sample({hit.p, hit.ns}, path.pair_for(*light), path.lambda);
            if (!arriving || arriving->pdf == 0) continue;
            Spectrum f = bsdf.local(wo, frame.to_local(arriving->wi));
            if (f.is_black()) continue;
            bool visible = true;
            if (shadows)
                visible = co_await path.visible(hit.spawn_to(arriving->p, arriving->p_error, arriving->ng));
            if (visible) sum += f * arriving->L / arriving->pdf;
        }
        co_return sum;
    }

    /// What a ray sees that hits nothing: black, or the scene's environment.
    static Spectrum background(const Ray& ray, PathContext& path) {
        Spectrum sum = 0;
        for (const Light* light : path.scene.infinite_lights())
            sum += light->escaped(ray.o, ray.d, path.lambda);
        return sum;
    }
};

} // namespace

Kind<Integrator> whitted_integrator() {
    return make_kind<Integrator, Whitted>("whitted");
}

} // namespace alhazen
