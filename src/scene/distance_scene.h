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
        return distances_.size() + nearest_.size() * sizeof(std::uint32_t) + planes_.size() * sizeof(Plane);
    }

  private:
    /// Where a triangle of the field is in the scene.
    struct Origin {
        std::uint32_t placed; ///< into placed_
        std::uint32_t primitive;
    };

    struct Collector;
    void sample();
    /// Samples stand in cubes of 4 x 4 x 4, whose distances are one line of the cache.
    std::size_t index(Vec3i p) const {
        const int cube = (p.x >> 2) + cubes_.x * ((p.y >> 2) + cubes_.y * (p.z >> 2));
        return static_cast<std::size_t>(cube) * 64 +
               static_cast<std::size_t>((p.x & 3) + 4 * (p.y & 3) + 16 * (p.z & 3));
    }
    /// A triangle that is near a point.
    struct Near {
        double distance2 = static_cast<double>(infinity);
        std::uint32_t triangle = 0;
        TrianglePoint at;
    };
    Near nearest_to(Vec3d p) const;
    /// A triangle as the march first asks it; all in cells.
    struct Plane {
        Vec3 n; ///< unit; zero for triangles without area
        float c = 0;
        float slack = 0; ///< what passes the plane within this of the triangle meets it
    };
    Plane plane_of(const Corners& triangle) const;
    float distance_to(std::uint32_t triangle, Vec3 grid_point) const; ///< in cells
    /// Of a line: q + d at for from < at < to, in cells.
    struct Stretch {
        Vec3 q, d;
        float from, to;
    };
    static bool is_within(float at, const Stretch& stretch) { return at > stretch.from && at < stretch.to; }
    /// Where the line crosses the triangle's plane.
    float crossing(std::uint32_t triangle, const Stretch& stretch) const;
    /// The same, if it is in the stretch and close to the triangle.
    std::optional<float> meets(std::uint32_t triangle, const Stretch& stretch) const;
    /// The first such among the triangles that are nearest to the samples around q.
    std::optional<float> meets_around(const Stretch& stretch) const;
    /// Where on its way from s to end a line of unit direction through the grid meets something; in cells.
    std::optional<float> march(Vec3 o, Vec3 d, float s, float end) const;
    std::optional<double> march(const Ray& ray, double end) const;
    Found found_at(const Ray& ray, double t) const;

    std::vector<Found> placed_; ///< object and way to it, once an object that is placed
    std::vector<Origin> origins_;
    std::vector<Corners> corners_;
    Vec3d lo_;
    double cell_ = 1;
    Vec3i n_{0, 0, 0}, cubes_{0, 0, 0};
    std::vector<std::uint8_t> distances_; ///< in eighths of a cell, rounded down
    std::vector<std::uint32_t> nearest_;
    std::vector<Plane> planes_; ///< of the triangles
};

} // namespace alhazen
