/// The sphere on a square, equal areas to equal areas: the octahedron unfolded, with the upper hemisphere as
/// the square's inner diamond and the lower folded out to its corners (Clarberg 2008, "Fast equal-area
/// mapping of the (hemi)sphere using SIMD"). Used for environment maps, the equal-area spherical camera, and
/// light hierarchies.
#pragma once

#include <utility>

#include "base/vec.h"

namespace alhazen {

/// The unit vector at p in [0, 1]^2; (1/2, 1/2) is +z.
inline Vec3 equal_area_to_sphere(Vec2 p) {
    float u = 2 * p.x - 1, v = 2 * p.y - 1;
    float au = std::abs(u), av = std::abs(v);
    float inside = 1 - (au + av); // positive within the diamond
    float r = 1 - std::abs(inside);
    float phi = (r == 0 ? 1 : (av - au) / r + 1) * (pi / 4);
    float z = std::copysign(1 - r * r, inside);
    float s = r * safe_sqrt(2 - r * r);
    return {std::copysign(s * std::cos(phi), u), std::copysign(s * std::sin(phi), v), z};
}

/// The place of the unit vector w in [0, 1]^2.
inline Vec2 sphere_to_equal_area(Vec3 w) {
    float x = std::abs(w.x), y = std::abs(w.y), z = std::abs(w.z);
    // r = sqrt(1 - z), but with all its digits near the poles.
    float r = std::sqrt((x * x + y * y) / (1 + z));
    float longer = std::max(x, y), shorter = std::min(x, y);
    float phi = (longer == 0 ? 0 : std::atan(shorter / longer)) * (2 / pi);
    if (x < y) phi = 1 - phi;
    float v = phi * r, u = r - v;
    if (w.z < 0) {
        std::swap(u, v);
        u = 1 - u;
        v = 1 - v;
    }
    auto to_unit = [](float a, float sign) {
        return std::clamp(0.5f * (std::copysign(a, sign) + 1), 0.0f, 1.0f);
    };
    return {to_unit(u, w.x), to_unit(v, w.y)};
}

/// A place up to one square's width outside the square, brought to the place inside that is the same point of
/// the sphere: crossing an edge comes back through the same edge, mirrored about its middle.
inline Vec2 wrap_equal_area(Vec2 p) {
    if (p.x < 0) p = {-p.x, 1 - p.y};
    if (p.x > 1) p = {2 - p.x, 1 - p.y};
    if (p.y < 0) p = {1 - p.x, -p.y};
    if (p.y > 1) p = {1 - p.x, 2 - p.y};
    return p;
}
/// The same for the texels of a size x size image.
inline Vec2i wrap_equal_area(Vec2i p, int size) {
    if (p.x < 0) p = {-p.x - 1, size - 1 - p.y};
    if (p.x >= size) p = {2 * size - 1 - p.x, size - 1 - p.y};
    if (p.y < 0) p = {size - 1 - p.x, -p.y - 1};
    if (p.y >= size) p = {size - 1 - p.x, 2 * size - 1 - p.y};
    return p;
}

} // namespace alhazen
