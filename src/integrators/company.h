/// Paths that one thread follows in company, for integrators that make whole pictures: while one waits for
/// its ray, the others go on, and their rays are traced together.
#pragma once

#include <memory>
#include <vector>

#include "integrators/path_context.h"

namespace alhazen {

/// T: what a path's task gives.
template <class T>
class Company {
  public:
    /// Where one path lives, and after it the next.
    struct Place {
        std::uint32_t number = 0; ///< 0 ... places - 1
        Arena arena{4096};
        std::optional<PathContext> context;
        std::optional<Task<T>> task;
    };

    /// places: how many paths at a time; 1: each ray is traced at once.
    Company(const Scene& scene, std::size_t places) : scene_(scene) {
        for (std::uint32_t i = 0; i < places; ++i) {
            places_.push_back(std::make_unique<Place>());
            places_.back()->number = i;
        }
    }

    /// begin(place) starts a path there by follow(), or returns false when there is none to start;
    /// end(place), when its task is done. Paths end in another order than they begin.
    template <class Begin, class End>
    void run(const Begin& begin, const End& end) {
        auto go_on = [&](Place& place) {
            while (place.task && place.task->done()) {
                end(place);
                place.task.reset();
                begin(place);
            }
        };
        for (const auto& place : places_)
            if (begin(*place)) go_on(*place);
        while (!queue_.empty()) queue_.trace(scene_, [&](std::uint32_t number) { go_on(*places_[number]); });
    }

    /// start(context) gives the path's task.
    template <class Start>
    void follow(Place& place, const SampleStream& samples, const Wavelengths& lambda, const Start& start) {
        place.arena.reset();
        place.context.emplace(scene_, samples, lambda, place.arena, counts,
                              places_.size() > 1 ? &queue_ : nullptr, place.number);
        place.task.emplace(start(*place.context));
    }

    RayCounts counts; ///< so far

  private:
    const Scene& scene_;
    RayQueue queue_;
    std::vector<std::unique_ptr<Place>> places_;
};

} // namespace alhazen
