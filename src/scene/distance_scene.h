/// A whole scene as one global distance field, as game engines keep one for indirect light (Wright et al.
/// 2022, "Lumen"): cheap to ask, coarse, and approximate. Details smaller than a cell are lost, and contacts
/// are blurred by about a cell.
#pragma once

#include <optional>

#include "scene/object.h"
#include "sdf/mesh_distance.h"

namespace alhazen {

/// Unsigned distances on a regular grid around all triangles, with the triangle that is nearest.
class DistanceScene {
  public:
    /// cells along the longest side of the scene. Throws std::runtime_error when there are shapes that are no
    /// triangles. Borders between media are left out. The root must outlive this.
    DistanceScene(const Object& root, int cells);

    /// The nearest surface at 0 < t < ray.tmax, as a hit on the triangle that is nearest there.
    std::optional<Hit> closest(const Ray& ray) const;
    /// True when nothing is seen before ray.tmax.
    bool visible(const Ray& ray) const;

    std::size_t bytes() const {
        return distances_.size() * sizeof(float) + nearest_.size() * sizeof(std::uint32_t);
    }

  private:
    /// Where a triangle of the field is in the scene.
    struct Origin {
        std::uint32_t placed; ///< into placed_
        std::uint32_t primitive;
    };

    struct Collector;
    void sample();
    std::size_t index(Vec3i p) const {
        return static_cast<std::size_t>(p.x) +
               static_cast<std::size_t>(n_.x) *
                   (static_cast<std::size_t>(p.y) +
                    static_cast<std::size_t>(n_.y) * static_cast<std::size_t>(p.z));
    }
    /// A triangle that is near a point.
    struct Near {
        double distance2 = static_cast<double>(infinity);
        std::uint32_t triangle = 0;
        TrianglePoint at;
    };
    Near nearest_to(Vec3d p) const;
    /// Number of the sample nearest to a point of the grid, and how far away it is, in cells.
    std::size_t nearest_sample(Vec3d grid_point, double& away) const;
    double distance_of_triangle(Vec3d grid_point, std::size_t sample) const; ///< in cells
    std::optional<double> march(const Ray& ray, double end) const;
    Found found_at(const Ray& ray, double t) const;

    std::vector<Found> placed_; ///< object and way to it, once an object that is placed
    std::vector<Origin> origins_;
    std::vector<Corners> corners_;
    Vec3d lo_;
    double cell_ = 1;
    Vec3i n_{0, 0, 0};
    std::vector<float> distances_; ///< in cells
    std::vector<std::uint32_t> nearest_;
};

} // namespace alhazen
