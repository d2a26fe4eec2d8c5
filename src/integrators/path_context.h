/// What one path carries with it: its random numbers, wavelengths and memory, and the way to the scene's
/// rays.
#pragma once

#include <cstdint>
#include <optional>

#include "base/arena.h"
#include "color/wavelengths.h"
#include "film/visible_surface.h"
#include "integrators/ray_queue.h"
#include "integrators/task.h"
#include "media/medium.h"
#include "samplers/sampler.h"
#include "scene/scene.h"

namespace alhazen {

/// Rays traced, by what they were for.
struct RayCounts {
    std::uint64_t camera = 0, bounce = 0, shadow = 0;
    std::uint64_t total() const { return camera + bounce + shadow; }
    RayCounts& operator+=(const RayCounts& o) {
        camera += o.camera;
        bounce += o.bounce;
        shadow += o.shadow;
        return *this;
    }
};

class PathContext {
  public:
    /// With a queue the path suspends for each ray, and goes by the given number there; without, rays are
    /// traced at once, one at a time. The numbers that come out are the same, bit by bit.
    PathContext(const Scene& scene_, SampleStream samples_, const Wavelengths& lambda_, Arena& arena_,
                RayCounts& counts, RayQueue* queue = nullptr, std::uint32_t number = 0)
        : scene(scene_), samples(samples_), lambda(lambda_), arena(arena_), counts_(counts), queue_(queue),
          number_(number) {}
    PathContext(const PathContext&) = delete;
    PathContext& operator=(const PathContext&) = delete;

    const Scene& scene;
    SampleStream samples;
    Wavelengths lambda;
    Arena& arena;
    /// Is told what the camera ray sees first; nullptr when nobody asks.
    VisibleSurface* surface = nullptr;

    /// The pair of random numbers for a point on the light; none are drawn for a light without size.
    Vec2 pair_for(const Light& light) {
        if (light.has_extent()) return samples.next2();
        samples.skip(2);
        return {};
    }

    /// The medium's colours at the path's wavelengths, which stay what they are (dispersion changes their
    /// densities only).
    const MediumColors& colors_of(const Medium& medium) {
        if (&medium != colored_) {
            colors_ = medium.colors(lambda);
            colored_ = &medium;
        }
        return colors_;
    }

    /// An awaitable that gives the nearest hit, or nullopt. The ray must live until then.
    auto closest(const Ray& ray) {
        // The first ray of a path comes from the camera.
        ++(first_ray_ ? counts_.camera : counts_.bounce);
        const DistanceScene* approximation = first_ray_ ? nullptr : scene.approximation();
        if (first_ray_) first_direction_ = ray.d;
        first_ray_ = false;
        return Closest{*this, ray, approximation};
    }
    /// The same on the way to a light: what is met may be only a border of media.
    auto closest_before_light(const Ray& ray) {
        ++counts_.shadow;
        return Closest{*this, ray, scene.approximation()};
    }
    /// An awaitable that gives true when nothing blocks the ray before its tmax.
    auto visible(const Ray& ray) {
        ++counts_.shadow;
        return Visible{*this, ray};
    }

  private:
    struct Closest {
        PathContext& path;
        const Ray& ray;
        const DistanceScene* approximation; ///< asked instead of the scene, when there is one
        std::uint32_t place = 0;

        bool await_ready() const noexcept { return !path.queue_; }
        void await_suspend(std::coroutine_handle<> waiting) {
            place = approximation ? path.queue_->add_approximate(ray, waiting, path.number_)
                                  : path.queue_->add_closest(ray, waiting, path.number_);
        }
        // The hit is made here, where it will stay.
        std::optional<Hit> await_resume() const {
            auto hit = path.queue_     ? Scene::surface(path.queue_->found(place))
                       : approximation ? approximation->closest(ray)
                                       : path.scene.closest(ray);
            if (!hit || approximation) return hit;
            hit->cone = path.scene.pixel_cone();
            if (path.surface) path.see(ray, *hit);
            return hit;
        }
    };
    struct Visible {
        PathContext& path;
        const Ray& ray;
        std::uint32_t place = 0;

        bool await_ready() const noexcept { return !path.queue_; }
        void await_suspend(std::coroutine_handle<> waiting) {
            place = path.queue_->add_shadow(ray, waiting, path.number_);
        }
        bool await_resume() const {
            if (path.queue_) return path.queue_->visible(place);
            const DistanceScene* approximation = path.scene.approximation();
            return approximation ? approximation->visible(ray) : path.scene.visible(ray);
        }
    };

    void see(const Ray& ray, const Hit& hit);

    RayCounts& counts_;
    RayQueue* queue_;
    std::uint32_t number_;
    const Medium* colored_ = nullptr; ///< the medium whose colours were asked for last
    MediumColors colors_;
    bool first_ray_ = true;
    Vec3 first_direction_;
};

inline Arena& task_detail::arena_of(PathContext& path) {
    return path.arena;
}

} // namespace alhazen
