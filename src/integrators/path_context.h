/// What one path carries with it: its random numbers, wavelengths and memory, and the way to the scene's
/// rays.
#pragma once

#include <array>
#include <cstdint>

#include "base/arena.h"
#include "color/wavelengths.h"
#include "integrators/task.h"
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
    PathContext(const Scene& scene_, SampleStream samples_, const Wavelengths& lambda_, Arena& arena_,
                RayCounts& counts)
        : scene(scene_), samples(samples_), lambda(lambda_), arena(arena_), counts_(counts) {}
    PathContext(const PathContext&) = delete;
    PathContext& operator=(const PathContext&) = delete;

    const Scene& scene;
    SampleStream samples;
    Wavelengths lambda;
    Arena& arena;

    /// An awaitable that gives the nearest hit, or nullopt. The ray, which must live until then, is traced at
    /// once, without suspending.
    auto closest(const Ray& ray) {
        // The first ray of a path comes from the camera.
        ++(first_ray_ ? counts_.camera : counts_.bounce);
        first_ray_ = false;
        // Traced in await_resume, so that the hit is made where it will stay.
        return Ready{[this, &ray] { return scene.closest(ray); }};
    }
    /// An awaitable that gives true when nothing blocks the ray before its tmax.
    auto visible(const Ray& ray) {
        ++counts_.shadow;
        return Ready{[this, &ray] { return scene.visible(ray); }};
    }

  private:
    template <class Answer>
    struct Ready {
        Answer answer;
        bool await_ready() const noexcept { return true; }
        void await_suspend(std::coroutine_handle<>) const noexcept {}
        auto await_resume() const { return answer(); }
    };
    template <class Answer>
    Ready(Answer) -> Ready<Answer>;

    RayCounts& counts_;
    bool first_ray_ = true;
};

inline Arena& task_detail::arena_of(PathContext& path) {
    return path.arena;
}

} // namespace alhazen
