/// Random boxes, triangles and rays, and the answers found by trying every primitive.
#pragma once

#include <vector>

#include "accel/accel.h"
#include "accel/box_ray.h"
#include "accel/triangle.h"
#include "base/hash.h"

namespace alhazen::accel_test {

inline Vec3 random_point(Rng& rng, float scale) {
    return Vec3{rng.uniform() - 0.5f, rng.uniform() - 0.5f, rng.uniform() - 0.5f} * (2 * scale);
}

/// Triangles, some of which may be custom (tested through PrimitiveTests) or filtered (only some hits count).
struct Triangles final : Primitives {
    std::vector<Corners> list;
    std::vector<PrimitiveKind> kinds; ///< empty: all are plain triangles

    Triangles() = default;
    explicit Triangles(std::vector<Corners> corners) : list(std::move(corners)) {}

    std::uint32_t count() const override { return static_cast<std::uint32_t>(list.size()); }
    PrimitiveKind kind(std::uint32_t i) const override {
        return kinds.empty() ? PrimitiveKind::triangle : kinds[i];
    }
    Bounds3 bounds(std::uint32_t i) const override {
        Bounds3 box;
        for (Vec3 p : {list[i].a, list[i].b, list[i].c}) box.extend(p);
        return box;
    }
    Corners corners(std::uint32_t i) const override { return list[i]; }

    std::vector<Bounds3> boxes() const { return padded_boxes(*this); }

    bool meets(const Ray& ray, std::uint32_t i, Intersection& hit) const {
        return intersect_triangle(ray, RayShear(ray), list[i].a, list[i].b, list[i].c, hit);
    }
    /// Filtered triangles are there where u > v.
    static bool counts(const Intersection& hit) { return hit.u > hit.v; }

    /// The nearest hit, of equally near ones the first.
    Intersection brute_force(Ray ray) const {
        Intersection best;
        for (std::uint32_t i = 0; i < list.size(); ++i) {
            Intersection candidate;
            if (!meets(ray, i, candidate)) continue;
            if (kind(i) == PrimitiveKind::filtered_triangle && !counts(candidate)) continue;
            best = candidate;
            best.primitive = i;
            ray.tmax = best.t;
        }
        return best;
    }
    void add(const Triangles& more) { list.insert(list.end(), more.list.begin(), more.list.end()); }
};

/// The tests of Triangles' custom and filtered primitives.
struct TriangleTests final : PrimitiveTests {
    const Triangles& triangles;
    std::size_t calls = 0;

    explicit TriangleTests(const Triangles& t) : triangles(t) {}
    bool intersect(const Question& q, Intersection& hit) override {
        ++calls;
        return triangles.meets(q.ray, q.primitive, hit);
    }
    bool accept(const Question&, const Intersection& hit) override { return Triangles::counts(hit); }
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
    const Corners& t = triangles.list[rng.below(static_cast<std::uint32_t>(triangles.list.size()))];
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

/// All pairs "builder/walk", and trees improved by reinsertion with every walk.
inline std::vector<AccelChoice> all_choices() {
    std::vector<AccelChoice> all;
    for (const AccelBuilder& b : accel_builders())
        for (const AccelWalk& w : accel_walks())
            all.push_back({std::string(b.name), std::string(w.name), {}});
    for (const char* improved : {"sah+reinsertion", "lbvh+reinsertion"})
        for (const AccelWalk& w : accel_walks()) all.push_back({improved, std::string(w.name), {}});
    return all;
}

} // namespace alhazen::accel_test
