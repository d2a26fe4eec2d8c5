/// How far apart two points of a surface, or the pixels on it, lie in its parameters u and v.
#pragma once

#include "base/hit.h"
#include "base/pixel_cone.h"

namespace alhazen {

/// The change of u and v that moves the hit's point by d, or comes nearest to it; zero where none does.
inline Vec2 parameter_step(const Hit& hit, Vec3 d) {
    const float uu = length_squared(hit.dpdu), uv = dot(hit.dpdu, hit.dpdv), vv = length_squared(hit.dpdv);
    const float determinant = uu * vv - uv * uv;
    if (!(determinant > 0)) return {};
    const float u = dot(hit.dpdu, d), v = dot(hit.dpdv, d);
    const Vec2 change{(vv * u - uv * v) / determinant, (uu * v - uv * u) / determinant};
    return std::isfinite(change.x) && std::isfinite(change.y) ? change : Vec2();
}

/// Half of what a pixel covers of u and of v; zero where it is not known.
inline Vec2 half_pixel(const Hit& hit) {
    if (!hit.cone) return {};
    const PixelCone::Ellipse ellipse = hit.cone->on_surface(hit.p, hit.ng);
    const Vec2 a = parameter_step(hit, ellipse.narrow), b = parameter_step(hit, ellipse.wide);
    return {(std::abs(a.x) + std::abs(b.x)) / 2, (std::abs(a.y) + std::abs(b.y)) / 2};
}

} // namespace alhazen
