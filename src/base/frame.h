/// Orthonormal frames: local coordinates in which z is the normal.
#pragma once

#include "base/vec.h"

namespace alhazen {

/// Right-handed orthonormal frame.
struct Frame {
    Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

    /// Any frame around the unit vector n, continuous but at n.z = 0 (Duff et al. 2017).
    static Frame from_z(Vec3 n) {
        float sign = std::copysign(1.0f, n.z);
        float a = -1 / (sign + n.z);
        float b = n.x * n.y * a;
        return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
    }
    /// The frame whose z is the unit vector n and whose x is as near tangent as can be; any frame around n
    /// when the tangent has no part across n.
    static Frame from_z_and_tangent(Vec3 n, Vec3 tangent) {
        Vec3 x = tangent - n * dot(n, tangent);
        float len2 = length_squared(x);
        if (!(len2 > 1e-12f * length_squared(tangent))) return from_z(n);
        x = x / std::sqrt(len2);
        return {x, cross(n, x), n};
    }
    Vec3 to_local(Vec3 v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
    Vec3 to_world(Vec3 v) const { return x * v.x + y * v.y + z * v.z; }
};

/// Trigonometry of directions in a local frame.
inline float cos_theta(Vec3 w) {
    return w.z;
}
inline float abs_cos_theta(Vec3 w) {
    return std::abs(w.z);
}
inline float cos2_theta(Vec3 w) {
    return w.z * w.z;
}
inline float sin2_theta(Vec3 w) {
    return std::max(0.0f, 1 - w.z * w.z);
}
inline bool same_hemisphere(Vec3 a, Vec3 b) {
    return a.z * b.z > 0;
}

} // namespace alhazen
