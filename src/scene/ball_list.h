/// The few whole spheres of an object, tested together: sooner done than walking a structure to each.
#pragma once

#include <cstdint>
#include <vector>

#include "accel/intersection.h"
#include "shapes/ball.h"

namespace alhazen {

/// Balls by their numbers as primitives. Gives the very hits that testing one after the other with
/// intersect_ray_sphere does.
class BallList {
  public:
    /// More are better off in an acceleration structure.
    static constexpr std::size_t most = 24;

    struct Numbered {
        Ball ball;
        std::uint32_t primitive;
    };
    BallList() = default;
    /// lanes: how many are tested at a time, which changes no bit of the answers: 2, or 4 where the processor
    /// has AVX2.
    explicit BallList(std::vector<Numbered> balls, int lanes = most_lanes());
    static int most_lanes();

    bool empty() const { return primitives.empty(); }

    /// Updates hit when a ball is met at 0 < t < ray.tmax before it, or at the same distance with a lower
    /// number.
    void closest(const Ray& ray, Intersection& hit) const;
    /// Whether a ball stands at 0 < t < ray.tmax.
    bool any(const Ray& ray) const;

    /// Of all balls, as vectors take them; at the end some that are never met, up to a multiple of four.
    std::vector<double> x, y, z, radius_squared;
    std::vector<std::uint32_t> primitives;

  private:
    bool takes_four_ = false;
};

} // namespace alhazen
