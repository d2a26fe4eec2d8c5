/// Light tracing (Arvo 1986, "Backward ray tracing"; Dutre and Willems 1994): paths start at the lights, and
/// each surface that they meet shows itself to the camera. The picture: caustics come out clear, lamps in
/// boxes are no trouble; but what is seen in mirrors and through glass stays black, as no path can aim at the
/// camera through them.
#include "integrators/integrator.h"
#include "integrators/light_start.h"
#include "integrators/shading_normal.h"
#include "materials/material.h"

namespace alhazen {

namespace {

struct LightPath final : Integrator {
    int maxdepth = 5;

    static void describe(Fields<LightPath>& f) {
        f.about(
            "Follows paths from the lights and joins each of their points with the camera. What is seen in "
            "mirrors or through glass, and the sky itself, stay black. As in pbrt-v4 it does not see "
            "participating media, and a warning says so where there are some; bdpt does.");
        f.field("maxdepth", &LightPath::maxdepth, "bounces of a path at most; 0 shows lights only")
            .in(0, 10000);
    }

    bool makes_splats() const override { return true; }
    bool follows_camera_rays() const override { return false; }
    void prepare(const PictureOrder& picture) override {
        camera_ = &picture.camera;
        film_ = &picture.film;
        lights_ = lights_by_power(picture.scene.lights());
    }

    /// The camera's ray only tells the time.
    Task<Spectrum> radiance(Ray camera_ray, PathContext& path) const override {
        const auto start = start_at_light(*lights_, path.samples, path.lambda, camera_ray.time);
        if (!start) co_return Spectrum(0);
        Hit from = start->place();
        if (auto view = see(from, path)) {
            from.wo = -view->d;
            const Spectrum L = start->seen_along(from, path.lambda) * abs_dot(from.ng, view->d);
            if (!L.is_black() && co_await path.visible(from.spawn_to(view->p, Vec3(), Vec3())))
                film_->add_splat(view->film, L * view->density, path.lambda);
        }

        Spectrum flux = start->flux();
        Ray ray = start->leaving.ray;
        for (int depth = 0;;) {
            const std::optional<Hit> hit = co_await path.closest(ray);
            if (!hit) break;
            Bsdf* bsdf = hit->material->at(*hit, path.lambda, path.arena);
            if (!bsdf) {
                ray = hit->spawn(ray.d);
                continue;
            }
            if (depth++ == maxdepth) break;
            if (depth == 1) flux *= start->growth(length_squared(hit->p - from.p));

            const Frame frame = hit->shading_frame();
            const Vec3 to_light = frame.to_local(hit->wo);
            if (auto view = see(*hit, path)) {
                const Spectrum f =
                    bsdf->eval(to_light, frame.to_local(-view->d), TransportMode::importance).f *
                    shading_correction(*hit, hit->wo, -view->d);
                if (!f.is_black() && co_await path.visible(hit->spawn_to(view->p, Vec3(), Vec3())))
                    film_->add_splat(view->film, flux * f * view->density, path.lambda);
            }
            const float u = path.samples.next1();
            const auto next = bsdf->sample(to_light, u, path.samples.next2(), TransportMode::importance);
            if (!next || next->pdf == 0) break;
            const Vec3 w = frame.to_world(next->wi);
            flux *= next->f * (shading_correction(*hit, hit->wo, w) / next->pdf);
            if (flux.is_black()) break;
            ray = hit->spawn(w);
        }
        co_return Spectrum(0);
    }

  private:
    /// The way to the camera, when the film is where it leads.
    std::optional<CameraConnection> see(const Hit& from, PathContext& path) const {
        const Vec2 lens = camera_->has_lens() ? path.samples.next2() : Vec2();
        auto view = camera_->sample_towards(from.p, lens, from.time);
        return view && film_->splat_reaches(view->film) ? view : std::nullopt;
    }

    const Camera* camera_ = nullptr;
    Film* film_ = nullptr;
    std::unique_ptr<LightChooser> lights_;
};

} // namespace

Kind<Integrator> lightpath_integrator() {
    return make_kind<Integrator, LightPath>("lightpath");
}

} // namespace alhazen
