/// Triangles as the eye sees them: on the unit sphere around a point.
#pragma once

#include "base/vec.h"

namespace alhazen {

/// The triangle with the given corners, seen from the eye.
class SphericalTriangle {
  public:
    SphericalTriangle(Vec3 pa, Vec3 pb, Vec3 pc, Vec3 eye);

    /// Steradians (Van Oosterom and Strackee 1983). NaN when the eye is on a corner.
    float solid_angle() const { return solid_angle_; }
    /// A point that is uniform over the solid angle, as weights of the second and the third corner, neither
    /// negative, their sum at most 1. u.x cuts off that fraction of the area by an arc through the second
    /// corner, u.y chooses a place along that arc (Arvo 1995, "Stratified Sampling of Spherical Triangles";
    /// the arc's end as Peters 2021, "BRDF Importance Sampling for Polygonal Lights", section 3). The solid
    /// angle must not be 0.
    Vec2 sample(Vec2 u) const;

  private:
    Vec3 inverse_distance_; ///< of each corner
    float ab_, bc_, ca_;    ///< cosines of the sides
    float volume_;          ///< of the parallelepiped of the directions to the corners
    float solid_angle_;
};

/// The solid angle by which lights sample the triangle; 0 where they do better by its area.
float sampled_solid_angle(const SphericalTriangle& seen);

} // namespace alhazen
