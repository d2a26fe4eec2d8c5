/// The kernel that follows bundles of rays, once for every instruction set: the recursion of whitted.cpp, and
/// the same operations in the same order, for eight rays at a time. A mask says which of the lanes a ray is
/// still in; the others are carried along, and what comes of them is dropped.
#pragma once

#include "integrators/bundle/balls_text.h"
#include "math/power.h"

namespace {

static_assert(lanes == alhazen::bundle_lanes);
constexpr int colors = alhazen::bundle_colors;
// See shadow_epsilon.
constexpr float shadow_end = 1 - 1e-4f;
constexpr float least_distance_squared = 0x1p-126f;
// exp(-104) rounds to 0.
constexpr float smallest_exponent = 105;

struct Color {
    Floats c[colors];
};

/// The material in each lane.
struct PhongLanes {
    Floats mirror, refract, eta, shininess;
    Color ambient, diffuse, specular;
};

ALHAZEN_INLINE void put(Floats& to, Ints where, float value) {
    to = where ? Floats{} + value : to;
}

ALHAZEN_INLINE PhongLanes gather_materials(const alhazen::BundleScene& scene, Ints ball, Ints active) {
    PhongLanes all{};
    for_each_ball(ball, active, [&](std::int32_t number, Ints where) {
        const alhazen::BundleBall& one = scene.balls[number];
        put(all.mirror, where, one.mirror);
        put(all.refract, where, one.refract);
        put(all.eta, where, one.eta);
        put(all.shininess, where, one.shininess);
        for (int c = 0; c < colors; ++c) {
            put(all.ambient.c[c], where, one.ambient[c]);
            put(all.diffuse.c[c], where, one.diffuse[c]);
            put(all.specular.c[c], where, one.specular[c]);
        }
    });
    return all;
}

// One axis of offset_origin.
ALHAZEN_INLINE Floats moved_off(Floats p, Floats offset) {
    constexpr int least_negative = static_cast<int>(0x80000001u);
    const Floats moved = p + offset;
    const Ints up = offset > 0, down = offset < 0, bits = __builtin_bit_cast(Ints, moved);
    const Ints is_negative = bits >> 31, step = ((down - up) ^ is_negative) - is_negative;
    const Ints beside_zero = (up & 1) | (down & least_negative);
    return __builtin_bit_cast(Floats, moved == 0 ? beside_zero : bits + step);
}

/// See offset_origin in base/ray.h.
ALHAZEN_INLINE Vector3 offset_origin(const SurfaceLanes& at, const Vector3& w) {
    const Floats distance = with_sign(dot(absolute(at.n), at.p_error), dot(w, at.n));
    return {moved_off(at.p.x, at.n.x * distance), moved_off(at.p.y, at.n.y * distance),
            moved_off(at.p.z, at.n.z * distance)};
}

/// See Frame::from_z.
struct FrameLanes {
    Vector3 x, y, z;

    ALHAZEN_INLINE explicit FrameLanes(const Vector3& n) : z(n) {
        const Floats sign = with_sign(Floats{} + 1.0f, n.z);
        const Floats a = -1.0f / (sign + n.z), b = n.x * n.y * a;
        x = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
        y = {b, sign + n.y * n.y * a, -n.y};
    }
    ALHAZEN_INLINE Vector3 to_local(const Vector3& v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
};

ALHAZEN_INLINE Vector3 reflect_ray(const Vector3& d, const Vector3& n) {
    return d - n * (2.0f * dot(d, n));
}

ALHAZEN_INLINE Vector3 refract_ray(const Vector3& d, const Vector3& n, Floats eta) {
    const Floats cos1 = -dot(d, n), sin2_squared = eta * eta * (1.0f - cos1 * cos1);
    const Vector3 refracted = normalize(d * eta + n * (eta * cos1 - square_root(1.0f - sin2_squared)));
    return select(sin2_squared > 1, reflect_ray(d, n), refracted);
}

ALHAZEN_INLINE Floats raised(Floats cosine, Floats n) {
    return narrow(alhazen::power_of_lanes<Doubles, Longs>(widen(cosine), widen(n)));
}

// See PhongBsdf::local; is_black comes back too.
ALHAZEN_INLINE Color local_light(const PhongLanes& k, const Vector3& wo, const Vector3& wi, Ints active,
                                 Ints& is_lit) {
    const Floats l_dot_n = wo.z < 0 ? -wi.z : wi.z;
    is_lit = active & ~(l_dot_n <= 0);
    Color f;
    Ints is_shiny{};
    for (int c = 0; c < colors; ++c) {
        f.c[c] = k.diffuse.c[c] * l_dot_n;
        is_shiny |= k.specular.c[c] != 0;
    }
    const Floats r_dot_v = -wi.x * wo.x + -wi.y * wo.y + wi.z * wo.z;
    // Beyond the last one, cos^n <= exp(-n (1 - cos)) is 0.
    const Ints has_highlight =
        is_lit & is_shiny & (r_dot_v > 0) & (k.shininess * (1.0f - r_dot_v) < smallest_exponent);
    if (any(has_highlight)) {
        const Floats lobe = raised(has_highlight ? r_dot_v : Floats{} + 1.0f, k.shininess);
        for (int c = 0; c < colors; ++c) f.c[c] = has_highlight ? f.c[c] + k.specular.c[c] * lobe : f.c[c];
    }
    Ints is_black = Ints{} - 1;
    for (int c = 0; c < colors; ++c) is_black &= f.c[c] == 0;
    is_lit &= ~is_black;
    return f;
}

class Tracer {
  public:
    Tracer(const alhazen::BundleScene& scene, alhazen::BundleCounts& counts)
        : scene_(scene), counts_(counts) {}

    Color trace_rays(const RayLanes& rays, Ints active, int depth) {
        if (depth == 0) return {};
        if (depth < scene_.maxdepth) counts_.bounce += count(active);
        const Nearest hit = find_closest(scene_, rays, active);
        active &= hit.ball >= 0;
        if (!any(active)) return {};

        const SurfaceLanes at = surface_of(scene_, rays, hit, active);
        const PhongLanes k = gather_materials(scene_, hit.ball, active);
        const Vector3 n = select(dot(at.n, at.wo) < 0, -at.n, at.n);
        Color sum = compute_lighting(at, k, hit.ball, active);
        for (Floats& c : sum.c) c = (1.0f - k.mirror) * c;
        if (const Ints mirrors = active & (k.mirror != 0); any(mirrors)) {
            const Vector3 d = reflect_ray(rays.d, n);
            add(sum, k.mirror, trace_rays({offset_origin(at, d), d}, mirrors, depth - 1), mirrors);
        }
        if (const Ints refracts = active & (k.refract != 0); any(refracts)) {
            const Ints entering = dot(rays.d, at.n) < 0;
            const Vector3 d = refract_ray(rays.d, n, entering ? 1.0f / k.eta : k.eta);
            add(sum, k.refract, trace_rays({offset_origin(at, d), d}, refracts, depth - 1), refracts);
        }
        for (Floats& c : sum.c) c = active ? c : Floats{};
        return sum;
    }

  private:
    ALHAZEN_INLINE static void add(Color& sum, Floats factor, const Color& seen, Ints where) {
        for (int c = 0; c < colors; ++c) sum.c[c] = where ? sum.c[c] + factor * seen.c[c] : sum.c[c];
    }

    // What may stand between a light and the balls in the active lanes.
    ALHAZEN_INLINE std::uint64_t blockers(const alhazen::BundleLight& light, Ints ball, Ints active) const {
        std::uint64_t all = 0;
        for_each_ball(ball, active, [&](std::int32_t number, Ints) { all |= light.blockers[number]; });
        return all;
    }

    ALHAZEN_INLINE Color compute_lighting(const SurfaceLanes& at, const PhongLanes& k, Ints ball,
                                          Ints active) {
        const FrameLanes frame(at.n);
        const Vector3 wo = frame.to_local(at.wo);
        Color sum = k.ambient;
        for (std::uint32_t i = 0; i < scene_.light_count; ++i) {
            const alhazen::BundleLight& light = scene_.lights[i];
            const Vector3 q{Floats{} + light.x, Floats{} + light.y, Floats{} + light.z};
            const Vector3 to_light = q - at.p;
            const Floats d2 = dot(to_light, to_light);
            const Ints arrives = active & (d2 >= least_distance_squared) & (d2 < infinite);
            const Vector3 wi = to_light * (1.0f / square_root(d2));
            Ints is_lit;
            Color f = local_light(k, wo, frame.to_local(wi), arrives, is_lit);
            if (!any(is_lit)) continue;
            if (scene_.shadows) {
                counts_.shadow += count(is_lit);
                const Vector3 o = offset_origin(at, to_light);
                is_lit &= ~find_any(scene_, {o, q - o}, is_lit, blockers(light, ball, is_lit), shadow_end);
            }
            for (int c = 0; c < colors; ++c) {
                const Floats L =
                    light.fades ? light.intensity[c] * (1.0f / d2) : Floats{} + light.intensity[c];
                sum.c[c] = is_lit ? sum.c[c] + f.c[c] * L : sum.c[c];
            }
        }
        return sum;
    }

    const alhazen::BundleScene& scene_;
    alhazen::BundleCounts& counts_;
};

void trace_bundle(const alhazen::BundleScene& scene, const alhazen::BundleRays& rays,
                  alhazen::BundleRadiance& radiance, alhazen::BundleCounts& counts) {
    RayLanes lanes_of_rays;
    __builtin_memcpy(&lanes_of_rays.o, rays.o, sizeof rays.o);
    __builtin_memcpy(&lanes_of_rays.d, rays.d, sizeof rays.d);
    const Ints numbers{0, 1, 2, 3, 4, 5, 6, 7};
    const Color color =
        Tracer(scene, counts)
            .trace_rays(lanes_of_rays, numbers < static_cast<std::int32_t>(rays.count), scene.maxdepth);
    __builtin_memcpy(radiance.color, &color, sizeof radiance.color);
}

} // namespace
