/// Shapes small enough to be right at a glance, so that the lights' tests depend on no other room's code
/// paths.
#pragma once

#include "math/warp.h"
#include "shapes/shape.h"

namespace alhazen {

/// Chosen by area; per steradian by the change of variables.
struct TestShape : Shape {
    std::optional<ShapeSample> sample_from(std::uint32_t i, Vec3 reference, Vec2 u) const override {
        ShapeSample s = sample(i, u);
        Vec3 d = s.p - reference;
        float cosine = abs_dot(normalize(d), s.ng);
        if (cosine == 0) return std::nullopt;
        s.pdf = length_squared(d) / (cosine * area(i));
        return s;
    }
    float pdf_from(std::uint32_t i, Vec3 reference, const Hit& hit, Vec3 wi) const override {
        return length_squared(hit.p - reference) / (abs_dot(wi, hit.ng) * area(i));
    }
    // The tests make their own hits.
    bool intersect(const Ray&, std::uint32_t, Intersection&) const override { return false; }
    Hit surface(const Ray&, std::uint32_t, const Intersection&) const override { return {}; }
    std::size_t bytes() const override { return sizeof *this; }
};

struct TestTriangle final : TestShape {
    Vec3 a, b, c;

    TestTriangle(Vec3 a_, Vec3 b_, Vec3 c_) : a(a_), b(b_), c(c_) {}
    Vec3 normal() const { return normalize(cross(b - a, c - a)); }
    Bounds3 bounds(std::uint32_t) const override {
        Bounds3 box;
        for (Vec3 p : {a, b, c}) box.extend(p);
        return box;
    }
    float area(std::uint32_t) const override { return length(cross(b - a, c - a)) / 2; }
    ShapeSample sample(std::uint32_t, Vec2 u) const override {
        Vec3 w = sample_triangle(u);
        return {a * w.x + b * w.y + c * w.z, Vec3(1e-6f), normal(), {w.y, w.z}, 1 / area(0)};
    }
    NormalCone normals(std::uint32_t) const override { return {normal(), 1}; }
};

struct TestSphere final : TestShape {
    Vec3 center;
    float radius;

    TestSphere(Vec3 c, float r) : center(c), radius(r) {}
    Bounds3 bounds(std::uint32_t) const override { return {center - Vec3(radius), center + Vec3(radius)}; }
    float area(std::uint32_t) const override { return 4 * pi * radius * radius; }
    ShapeSample sample(std::uint32_t, Vec2 u) const override {
        Vec3 n = sample_sphere(u);
        return {center + n * radius, Vec3(1e-6f), n, u, 1 / area(0)};
    }
};

/// The unit square at z = 0, normal +z, uv = xy.
struct TestSquare final : TestShape {
    Bounds3 bounds(std::uint32_t) const override { return {{0, 0, 0}, {1, 1, 0}}; }
    float area(std::uint32_t) const override { return 1; }
    ShapeSample sample(std::uint32_t, Vec2 u) const override { return {{u.x, u.y, 0}, {}, {0, 0, 1}, u, 1}; }
    NormalCone normals(std::uint32_t) const override { return {{0, 0, 1}, 1}; }
};

} // namespace alhazen
