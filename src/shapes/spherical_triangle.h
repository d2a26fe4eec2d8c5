/// Triangles as the eye sees them: on the unit sphere around a point.
#pragma once

#include "base/vec.h"

namespace alhazen {

/// The triangle whose corners lie in the unit directions a, b and c.
struct SphericalTriangle {
    Vec3d a, b, c;

    SphericalTriangle(Vec3d pa, Vec3d pb, Vec3d pc, Vec3d eye)
        : a(normalize(pa - eye)), b(normalize(pb - eye)), c(normalize(pc - eye)) {}

    /// Van Oosterom and Strackee 1983. NaN when the eye is on a corner.
    double solid_angle() const {
        return std::abs(2 * std::atan2(dot(a, cross(b, c)), 1 + dot(a, b) + dot(a, c) + dot(b, c)));
    }

    /// A direction uniform over the triangle (Arvo 1995, "Stratified Sampling of Spherical Triangles"): u.x
    /// cuts off that fraction of the area by an arc through b, u.y chooses a place along that arc.
    Vec3d sample(Vec2d u) const;
};

} // namespace alhazen
