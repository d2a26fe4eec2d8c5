/// Random boxes, triangles and rays, and the answers found by trying every primitive.
#pragma once

#include <vector>

#include "accel/bvh.h"
#include "base/hash.h"
#include "shapes/triangle.h"

namespace alhazen::accel_test {

inline Vec3 random_point(Rng& rng, float scale) {
    return Vec3{rng.uniform() - 0.5f, rng.uniform() - 0.5f, rng.uniform() - 0.5f} * (2 * scale);
}

struct Triangle {
    Vec3 a, b, c;
};

struct Triangles {
    std::vector<Triangle> list;

    std::vector<Bounds3> boxes() const {
        std::vector<Bounds3> boxes(list.size());
        for (std::size_t i = 0; i < list.size(); ++i)
            for (Vec3 p : {list[i].a, list[i].b, list[i].c}) boxes[i].extend(p);
        return boxes;
    }
    auto leaf(const Ray& ray) const {
        return [this, shear = RayShear(ray)](std::uint32_t i, const Ray& r, Intersection& hit) {
            return intersect_triangle(r, shear, list[i].a, list[i].b, list[i].c, hit);
        };
    }
    /// The nearest hit, of equally near ones the first.
    Intersection brute_force(Ray ray) const {
        Intersection best;
        auto test = leaf(ray);
        for (std::uint32_t i = 0; i < list.size(); ++i) {
            Intersection candidate;
            if (!test(i, ray, candidate)) continue;
            best = candidate;
            best.primitive = i;
            ray.tmax = best.t;
        }
        return best;
    }
};

inline Triangles random_triangles(std::size_t count, float scale, float size, std::uint64_t seed) {
    Rng rng(seed);
    Triangles t;
    for (std::size_t i = 0; i < count; ++i) {
        Vec3 p = random_point(rng, scale);
        t.list.push_back(
            {p + random_point(rng, size), p + random_point(rng, size), p + random_point(rng, size)});
    }
    return t;
}

/// Rays of every kind: arbitrary ones, ones aimed at vertices and at points of edges, and axis-parallel ones,
/// some from vertices.
inline Ray random_ray(const Triangles& triangles, float scale, Rng& rng) {
    const Triangle& t = triangles.list[rng.below(static_cast<std::uint32_t>(triangles.list.size()))];
    Vec3 o = random_point(rng, 2 * scale);
    switch (rng.below(5)) {
    case 0:
        return {o, random_point(rng, 1)};
    case 1:
        return {o, t.a - o};
    case 2:
        return {o, lerp(rng.uniform(), t.b, t.c) - o};
    default: {
        Vec3 d;
        d[static_cast<int>(rng.below(3))] = rng.below(2) ? 1.0f : -1.0f;
        Vec3 through = rng.below(2) ? t.a : (t.a + t.b + t.c) * (1 / 3.0f);
        return {through - d * (rng.below(2) ? 4 * scale : 0.0f), d};
    }
    }
}

} // namespace alhazen::accel_test
