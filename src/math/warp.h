/// From uniform numbers to points and directions. Each map takes the unit square to a shape so that equal
/// areas stay equal (or follow the stated density); beside each stand its density and, where the map is one
/// to one, its inverse. Picture a rubber square stretched over a disk, a dome, a cone: neighbours stay
/// neighbours, so that well-spread squares of numbers give well-spread directions. Local directions have z as
/// the axis.
#pragma once

#include "base/vec.h"
#include "math/density.h"

namespace alhazen {

/// The unit disk around the origin, by concentric squares (Shirley and Chiu 1997). u in [0, 1]^2.
inline Vec2 sample_disk(Vec2 u) {
    float a = 2 * u.x - 1, b = 2 * u.y - 1;
    if (a == 0 && b == 0) return {0, 0};
    // The quarter of the square towards +-x, and that towards +-y: the longer coordinate is the radius, the
    // other the angle.
    if (std::abs(a) > std::abs(b)) {
        float theta = (pi / 4) * (b / a);
        return {a * std::cos(theta), a * std::sin(theta)};
    }
    float theta = (pi / 4) * (a / b);
    return {b * std::sin(theta), b * std::cos(theta)};
}
/// Per area.
inline constexpr float disk_pdf() {
    return inv_pi;
}
/// The u of sample_disk for a point of the disk.
inline Vec2 invert_disk(Vec2 p) {
    if (p.x == 0 && p.y == 0) return {0.5f, 0.5f};
    float r = length(p), a = 0, b = 0;
    if (std::abs(p.x) > std::abs(p.y)) {
        a = std::copysign(r, p.x);
        b = a * std::atan(p.y / p.x) * (4 / pi);
    } else {
        b = std::copysign(r, p.y);
        a = b * std::atan(p.x / p.y) * (4 / pi);
    }
    return {std::clamp(0.5f * (a + 1), 0.0f, 1.0f), std::clamp(0.5f * (b + 1), 0.0f, 1.0f)};
}

/// Directions with z >= 0, all alike.
inline Vec3 sample_hemisphere(Vec2 u) {
    float r = safe_sqrt(1 - u.x * u.x);
    float phi = 2 * pi * u.y;
    return {r * std::cos(phi), r * std::sin(phi), u.x};
}
/// Per solid angle, for z >= 0.
inline constexpr float hemisphere_pdf() {
    return inv_pi / 2;
}
inline Vec2 invert_hemisphere(Vec3 w) {
    float phi = std::atan2(w.y, w.x) * (inv_pi / 2);
    return {w.z, phi < 0 ? phi + 1 : phi};
}

/// Directions with z >= 0, in proportion to z (Malley's method: the disk lifted to the dome).
inline Vec3 sample_cosine_hemisphere(Vec2 u) {
    Vec2 d = sample_disk(u);
    return {d.x, d.y, safe_sqrt(1 - d.x * d.x - d.y * d.y)};
}
/// Per solid angle; cos_theta is the direction's z, 0 below the horizon.
inline float cosine_hemisphere_pdf(float cos_theta) {
    return std::max(0.0f, cos_theta) * inv_pi;
}
inline Vec2 invert_cosine_hemisphere(Vec3 w) {
    return invert_disk({w.x, w.y});
}

/// All directions alike.
inline Vec3 sample_sphere(Vec2 u) {
    float z = 1 - 2 * u.x;
    float r = 2 * safe_sqrt(u.x * (1 - u.x));
    float phi = 2 * pi * u.y;
    return {r * std::cos(phi), r * std::sin(phi), z};
}
/// Per solid angle.
inline constexpr float sphere_pdf() {
    return inv_pi / 4;
}
inline Vec2 invert_sphere(Vec3 w) {
    float phi = std::atan2(w.y, w.x) * (inv_pi / 2);
    return {std::clamp(0.5f * (1 - w.z), 0.0f, 1.0f), phi < 0 ? phi + 1 : phi};
}

/// 1 - cos of the angle whose sine squared is sin2 (0 ... 1), without cancellation for small angles.
inline float one_minus_cos_from_sin2(float sin2) {
    return sin2 / (1 + safe_sqrt(1 - sin2));
}
/// Directions within a cone about z, all alike. The cone is given by 1 - cos of its half angle (0 ... 2),
/// since its cosine alone would leave no digits for narrow cones.
inline Vec3 sample_cone(Vec2 u, float one_minus_cos_max) {
    float h = u.x * one_minus_cos_max;
    float sin_theta = safe_sqrt(h * (2 - h));
    float phi = 2 * pi * u.y;
    return {sin_theta * std::cos(phi), sin_theta * std::sin(phi), 1 - h};
}
/// Per solid angle, within the cone; infinite for a cone without width.
inline float cone_pdf(float one_minus_cos_max) {
    return inv_pi / 2 / one_minus_cos_max;
}
inline Vec2 invert_cone(Vec3 w, float one_minus_cos_max) {
    // 1 - cos = sin^2 / (1 + cos), without cancellation towards the axis.
    float h = w.z > 0 ? (w.x * w.x + w.y * w.y) / (1 + w.z) : 1 - w.z;
    float phi = std::atan2(w.y, w.x) * (inv_pi / 2);
    return {std::clamp(h / one_minus_cos_max, 0.0f, 1.0f), phi < 0 ? phi + 1 : phi};
}

/// Barycentric weights of a triangle's corners, uniform over its area (per unit area the density is 1 /
/// area). The square is folded along its diagonal instead of squeezed into a corner (Heitz 2019, "A
/// low-distortion map between triangle and square").
inline Vec3 sample_triangle(Vec2 u) {
    float b0 = 0, b1 = 0;
    if (u.x < u.y) {
        b0 = u.x / 2;
        b1 = u.y - b0;
    } else {
        b1 = u.y / 2;
        b0 = u.x - b1;
    }
    return {b0, b1, 1 - b0 - b1};
}
inline Vec2 invert_triangle(Vec3 b) {
    if (b.x > b.y) return {b.x + b.y, 2 * b.y};
    return {2 * b.x, b.x + b.y};
}

} // namespace alhazen
