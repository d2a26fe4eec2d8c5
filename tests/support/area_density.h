/// When two densities of choosing a point by area, seen from a place, agree as far as rays of floats can
/// tell. The density per steradian is distance^2 / (area cos): next to where a surface is seen edge-on, a ray
/// that is a rounding off meets it where the cosine is another.
#pragma once

#include "base/vec.h"

namespace alhazen::testing_support {

/// A point of a surface with the density of choosing it.
struct ChosenPoint {
    Vec3 p, p_error;
    float pdf = 0; ///< per steradian
};

/// |cosine| between the surface's normal and the direction from the reference, as the density has it.
inline double cosine_of(const ChosenPoint& chosen, Vec3 reference, float area) {
    Vec3d v = Vec3d(chosen.p) - Vec3d(reference);
    return dot(v, v) / (static_cast<double>(chosen.pdf) * static_cast<double>(area));
}

/// By how much the cosines' squares may differ between a sampled point and what the ray towards it meets.
///
/// The float ray passes the point at a distance e: its direction is rounded by up to 2^-23, and both points
/// are. Walking along a surface of normal curvature k, below the ray, the cosine c changes by k a step of 1,
/// and the distance to the ray by c: d(c^2) = 2 k de. A step e across the ray turns the normal by k e more:
/// another 2 k e at most. Then both normals are rounded, by 2^-23 each with their products.
inline double squared_cosine_slack(const ChosenPoint& sampled, const ChosenPoint& met, Vec3 reference,
                                   double curvature, double cosine) {
    double distance = length(Vec3d(sampled.p) - Vec3d(reference));
    double e = distance * 0x1p-23 + length(Vec3d(sampled.p_error)) + length(Vec3d(met.p_error));
    return 4 * curvature * e + 2 * cosine * (0x1p-21 + 2 * e / distance);
}

/// Whether the densities agree to rounding. curvature: at least the surface's largest, per unit of length.
inline bool same_density(const ChosenPoint& sampled, const ChosenPoint& met, Vec3 reference, float area,
                         double curvature) {
    double a = cosine_of(sampled, reference, area), b = cosine_of(met, reference, area);
    return std::abs(a * a - b * b) <=
           squared_cosine_slack(sampled, met, reference, curvature, std::max(a, b));
}

} // namespace alhazen::testing_support
