/// Matte points seen and lit many at a time, once for every instruction set: the operations of FilmRays and
/// LocalLight::at, in their order. Lanes beyond the last point are carried along.
#pragma once

#include "raster/kernel_text.h"

namespace {

using alhazen::RasterLight;
using alhazen::RasterPoints;
using alhazen::RasterRays;

static_assert(RasterPoints::lanes % lanes == 0);

constexpr float inverse_pi = 0x1.45f306p-2f;

struct ThreeFloats {
    Floats x, y, z;
};

ALHAZEN_INLINE ThreeFloats load_three(const RasterPoints::Array& x, const RasterPoints::Array& y,
                                      const RasterPoints::Array& z, std::uint32_t i) {
    return {load<Floats>(x + i), load<Floats>(y + i), load<Floats>(z + i)};
}
// Compilers make one instruction of such a loop over an array, not over lanes.
ALHAZEN_INLINE Floats square_root(Floats v) {
    alignas(64) float numbers[lanes];
    __builtin_memcpy(numbers, &v, sizeof v);
    for (float& number : numbers) number = __builtin_sqrtf(number);
    return load<Floats>(numbers);
}
ALHAZEN_INLINE Floats size_of(Floats v) {
    return v < 0 ? -v : v;
}

void place_points(const RasterRays& rays, RasterPoints& points) {
    for (std::uint32_t i = 0; i < points.count; i += lanes) {
        const Floats film_x = load<Floats>(points.film_x + i), film_y = load<Floats>(points.film_y + i);
        const Floats nearness = load<Floats>(points.nearness + i);
        auto moved = [&](const float(&from)[3], int axis) {
            return from[axis] + rays.across[axis] * film_x + rays.down[axis] * film_y;
        };
        ThreeFloats o, d;
        Floats steps = -nearness;
        if (rays.is_perspective) {
            o = {Floats{} + rays.start[0], Floats{} + rays.start[1], Floats{} + rays.start[2]};
            d = {moved(rays.ahead, 0), moved(rays.ahead, 1), moved(rays.ahead, 2)};
            steps = 1 / nearness;
        } else {
            o = {moved(rays.start, 0), moved(rays.start, 1), moved(rays.start, 2)};
            d = {Floats{} + rays.ahead[0], Floats{} + rays.ahead[1], Floats{} + rays.ahead[2]};
        }
        store(points.px + i, o.x + d.x * steps);
        store(points.py + i, o.y + d.y * steps);
        store(points.pz + i, o.z + d.z * steps);
        const ThreeFloats n = load_three(points.nx, points.ny, points.nz, i);
        const Floats one = Floats{} + 1.0f, turn = n.x * d.x + n.y * d.y + n.z * d.z > 0 ? -one : one;
        store(points.nx + i, n.x * turn);
        store(points.ny + i, n.y * turn);
        store(points.nz + i, n.z * turn);
    }
}

ALHAZEN_INLINE Floats distant_part(const RasterLight& light, const ThreeFloats& n) {
    const Floats cosine = light.normal[0] * n.x + light.normal[1] * n.y + light.normal[2] * n.z;
    return cosine > 0 ? cosine : Floats{};
}

ALHAZEN_INLINE Floats near_part(const RasterLight& light, const ThreeFloats& p, const ThreeFloats& n) {
    const Floats dx = light.p[0] - p.x, dy = light.p[1] - p.y, dz = light.p[2] - p.z;
    const Floats d2 = dx * dx + dy * dy + dz * dz;
    const Floats received = dx * n.x + dy * n.y + dz * n.z;
    const Floats inverse = 1 / square_root(d2);
    // A round light sends the same to all sides; of a flat one's back nothing comes.
    Floats sent = Floats{} + 1.0f;
    if (light.is_flat) {
        const Floats along = -(dx * light.normal[0] + dy * light.normal[1] + dz * light.normal[2]);
        sent = (light.is_two_sided ? size_of(along) : along) * inverse;
    }
    const Floats value = received * inverse * sent * light.area / (d2 + light.area * inverse_pi);
    return ((received > 0) & (sent > 0)) ? value : Floats{};
}

void light_points(const RasterLight& light, const RasterPoints& points, float* part) {
    for (std::uint32_t i = 0; i < points.count; i += lanes) {
        const ThreeFloats n = load_three(points.nx, points.ny, points.nz, i);
        if (light.is_distant)
            store(part + i, distant_part(light, n));
        else
            store(part + i, near_part(light, load_three(points.px, points.py, points.pz, i), n));
    }
}

} // namespace
