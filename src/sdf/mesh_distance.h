/// Distances from triangles, and whether a point is inside of them however they are flawed.
#pragma once

#include <optional>
#include <vector>

#include "accel/build/tree.h"
#include "base/vec.h"

namespace alhazen {

/// The point of the triangle that is nearest to p (Ericson 2005, "Real-Time Collision Detection",
/// section 5.1.5), by its barycentric weights of b and c.
struct TrianglePoint {
    Vec3d p;
    double b = 0, c = 0;
};
TrianglePoint nearest_on_triangle(Vec3d a, Vec3d b, Vec3d c, Vec3d p);

/// Immutable once built; any thread may ask.
class MeshDistance {
  public:
    enum class Asked { nearest, insides };
    /// Triangles with corners that are not finite are left out. insides: winding numbers are asked for, too.
    /// Builds on the threads of the enclosing with_threads.
    explicit MeshDistance(std::vector<Corners> triangles, Asked asked = Asked::insides);

    struct Nearest {
        double distance = 0;
        std::uint32_t triangle = 0;
        TrianglePoint at;
    };
    /// The triangle nearest to p; nullopt when none is nearer than limit.
    std::optional<Nearest> nearest(Vec3d p, double limit) const;

    /// The generalised winding number (Jacobson, Kavan and Sorkine-Hornung 2013): the solid angle that the
    /// triangles fill seen from p, over 4 pi, counted by their orientation. 1 inside a closed surface, 0
    /// outside, and between where it has holes. Groups of triangles that are far away count by their Taylor
    /// expansion to second order (Barill et al. 2018, "Fast Winding Numbers for Soups and Clouds"); errors
    /// were measured to stay below 0.02.
    double winding_number(Vec3d p) const;
    /// Whether p is inside: by half of a turn, whichever way the triangles are oriented.
    bool is_inside(Vec3d p) const { return std::abs(winding_number(p)) > 0.5; }

    const Bounds3& bounds() const { return bounds_; }
    std::size_t count() const { return triangles_.size(); }

  private:
    /// What a node's triangles are seen as from afar.
    struct Moments {
        Vec3d centre;         ///< mean of the triangles, by area
        double radius = 0;    ///< that all of them are within
        Vec3d dipole;         ///< sum of area times normal
        double quadrupole[9]; ///< sum of (centroid - centre) x (area times normal)
    };
    void measure(std::uint32_t node);

    std::vector<Corners> triangles_;
    Tree tree_;
    std::vector<Moments> moments_; ///< one a node
    Bounds3 bounds_;
};

} // namespace alhazen
