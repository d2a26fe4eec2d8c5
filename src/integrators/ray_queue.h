/// Rays that wait to be traced, many at a time, and the paths that wait for them: what lets an integrator's
/// text stay sequential while its rays travel in company.
#pragma once

#include <algorithm>
#include <array>
#include <coroutine>
#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace alhazen {

/// One thread's rays in waiting. A path that needs a ray adds it and suspends; trace() answers many at once
/// and resumes their paths, which read the answers and may add new rays meanwhile.
class RayQueue {
  public:
    /// Adds a ray; the path's number comes back in trace(). The answer is at the returned place when the path
    /// is resumed, until it suspends again.
    std::uint32_t add_closest(const Ray& ray, std::coroutine_handle<> path, std::uint32_t number) {
        return of(closest).add(ray, path, number);
    }
    /// Is answered by the scene's approximation, which must be there.
    std::uint32_t add_approximate(const Ray& ray, std::coroutine_handle<> path, std::uint32_t number) {
        return of(approximate).add(ray, path, number);
    }
    /// Is answered by the scene's approximation, where there is one.
    std::uint32_t add_shadow(const Ray& ray, std::coroutine_handle<> path, std::uint32_t number) {
        return of(shadow).add(ray, path, number);
    }
    const Found& found(std::uint32_t place) const { return found_[place]; }
    bool visible(std::uint32_t place) const { return !blocked_[place]; }

    bool empty() const {
        return std::all_of(waiting_.begin(), waiting_.end(), [](const Waiting& w) { return w.rays.empty(); });
    }

    /// Traces the rays of the kind of which most are waiting and resumes their paths in the order in which
    /// they came; after each calls after(number of the path).
    template <class After>
    void trace(const Scene& scene, const After& after) {
        const auto most =
            std::max_element(waiting_.begin(), waiting_.end(), [](const Waiting& a, const Waiting& b) {
                return a.rays.size() < b.rays.size();
            });
        std::swap(traced_, *most);
        trace(scene, static_cast<Kind>(most - waiting_.begin()));
        for (std::size_t i = 0; i < traced_.paths.size(); ++i) {
            traced_.paths[i].resume();
            after(traced_.numbers[i]);
        }
        traced_.clear();
    }

  private:
    struct Waiting {
        std::vector<Ray> rays;
        std::vector<std::coroutine_handle<>> paths;
        std::vector<std::uint32_t> numbers;

        std::uint32_t add(const Ray& ray, std::coroutine_handle<> path, std::uint32_t number) {
            rays.push_back(ray);
            paths.push_back(path);
            numbers.push_back(number);
            return static_cast<std::uint32_t>(rays.size() - 1);
        }
        void clear() {
            rays.clear();
            paths.clear();
            numbers.clear();
        }
    };

    enum Kind : std::size_t { closest, approximate, shadow, kinds };
    Waiting& of(Kind kind) { return waiting_[kind]; }
    void trace(const Scene& scene, Kind kind);

    std::array<Waiting, kinds> waiting_;
    Waiting traced_;
    std::vector<Intersection> hits_;
    std::vector<Found> found_;
    std::vector<std::uint8_t> blocked_;
};

} // namespace alhazen
