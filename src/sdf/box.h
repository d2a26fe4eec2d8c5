/// Boxes in double precision, which may reach to infinity.
#pragma once

#include <limits>

#include "base/transform.h"
#include "base/vec.h"

namespace alhazen {

/// lo <= p <= hi, axis by axis; empty when lo > hi on some axis.
struct Box {
    static constexpr double far = std::numeric_limits<double>::infinity();
    Vec3d lo{-far, -far, -far}, hi{far, far, far};

    static Box around(Vec3d half) { return {-half, half}; }
    bool is_empty() const { return lo.x > hi.x || lo.y > hi.y || lo.z > hi.z; }
    bool is_bounded() const { return is_finite(lo) && is_finite(hi); }
    Vec3d size() const { return hi - lo; }
    Vec3d centre() const { return (lo + hi) * 0.5; }
    Box grown(double by) const { return {lo - Vec3d(by), hi + Vec3d(by)}; }
    /// Largest distance of the box from the z axis.
    double radius_about_z() const {
        return std::hypot(std::max(std::abs(lo.x), std::abs(hi.x)), std::max(std::abs(lo.y), std::abs(hi.y)));
    }
    /// 0 inside.
    double distance(Vec3d p) const {
        Vec3d out = max(max(lo - p, p - hi), Vec3d{});
        return out == Vec3d{} ? 0.0 : length(out);
    }
    Box united(const Box& o) const { return {min(lo, o.lo), max(hi, o.hi)}; }
    Box intersected(const Box& o) const { return {max(lo, o.lo), min(hi, o.hi)}; }
};

/// Around the box seen through an affine transformation.
Box transformed(const Matrix4& m, const Box& box);

} // namespace alhazen
