/// A whole sphere in world space, met in double precision.
#pragma once

#include "base/ray.h"

namespace alhazen {

/// What the tests of many balls by one ray share.
struct BallRay {
    Vec3d o, d;
    double a, inverse_a; ///< d.d and 1 / d.d

    explicit BallRay(const Ray& ray) : o(ray.o), d(ray.d), a(dot(d, d)), inverse_a(1 / a) {}
};

/// The smaller positive root of a t^2 + 2 h t + c = 0, where the discriminant h^2 - a c is known to be
/// positive or zero: where a ray enters a ball, or leaves it from inside. 0 when it flies away from it.
inline double smaller_positive_root(double a, double h, double c, double discriminant) {
    if (c > 0 && h >= 0) return 0;
    // The roots are q / a and c / q, up to both signs; from inside, where c < 0, one of them is positive.
    double q = std::abs(h) + std::sqrt(discriminant);
    if (c > 0) return c / q;
    return h < 0 ? q / a : -c / q;
}

/// The smaller positive root of (d.d) t^2 + 2 d.(o - centre) t + (o - centre)^2 - r^2 = 0, which is where the
/// ray o + t d enters the ball, or leaves it from inside. 0 when the ray misses (or is NaN).
inline double intersect_ray_sphere(const BallRay& ray, Vec3d centre, double r) {
    Vec3d o = ray.o - centre;
    double h = dot(o, ray.d), c = dot(o, o) - r * r;
    // How far the ray passes the centre tells the discriminant without cancellation (Haines et al. 2019,
    // "Precision Improvements for Ray/Sphere Intersection").
    Vec3d miss = o - ray.d * (h * ray.inverse_a);
    double above = r * r - dot(miss, miss);
    return above >= 0 ? smaller_positive_root(ray.a, h, c, ray.a * above) : 0;
}

/// A ball.
struct Ball {
    Vec3d centre;
    double radius = 1;
    bool is_turned = false; ///< its normals point inward

    double intersect(const BallRay& ray) const { return intersect_ray_sphere(ray, centre, radius); }
};

} // namespace alhazen
