#include "shapes/triangle_pair.h"

#include <algorithm>

#include "shapes/spherical_triangle.h"

namespace alhazen {

namespace {

// Which of two things of these sizes u falls into; u becomes uniform again.
std::uint32_t choose(float first, float second, float& u) {
    const float share = first / (first + second);
    const bool is_second = u >= share;
    u = std::min(is_second ? (u - share) / (1 - share) : u / share, one_minus_epsilon);
    return is_second ? 1 : 0;
}

SphericalTriangle seen_from(const TriangleMesh& mesh, std::uint32_t triangle, Vec3 eye) {
    const auto [a, b, c] = mesh.vertices(triangle);
    return {a, b, c, eye};
}

int shared_corners(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
    int shared = 0;
    for (Vec3 p : a) shared += static_cast<int>(std::count(b.begin(), b.end(), p));
    return shared;
}

} // namespace

TrianglePair::TrianglePair(const TriangleMesh& mesh, std::uint32_t first)
    : mesh_(mesh), first_(first), areas_{mesh.area(first), mesh.area(first + 1)} {
    alpha = mesh.alpha;
}

std::unique_ptr<TrianglePair> TrianglePair::make(const TriangleMesh& mesh, std::uint32_t first) {
    constexpr float same_direction = 0.99999f;
    if (first + 1 >= mesh.primitive_count()) return nullptr;
    const NormalCone a = mesh.normals(first), b = mesh.normals(first + 1);
    if (a.cosine < 1 || b.cosine < 1 || !(dot(a.axis, b.axis) > same_direction)) return nullptr;
    if (shared_corners(mesh.vertices(first), mesh.vertices(first + 1)) != 2) return nullptr;
    if (!(mesh.area(first) > 0 && mesh.area(first + 1) > 0)) return nullptr;
    return std::make_unique<TrianglePair>(mesh, first);
}

Bounds3 TrianglePair::bounds(std::uint32_t) const {
    Bounds3 b = mesh_.bounds(first_);
    b.extend(mesh_.bounds(first_ + 1));
    return b;
}

bool TrianglePair::intersect(const Ray& ray, std::uint32_t, Intersection& hit) const {
    return mesh_.intersect(ray, first_, hit) || mesh_.intersect(ray, first_ + 1, hit);
}

Hit TrianglePair::surface(const Ray& ray, std::uint32_t, const Intersection& met) const {
    Intersection again;
    return mesh_.surface(ray, mesh_.intersect(ray, first_, again) ? first_ : first_ + 1, met);
}

ShapeSample TrianglePair::sample(std::uint32_t, Vec2 u) const {
    const std::uint32_t i = choose(areas_[0], areas_[1], u.x);
    ShapeSample s = mesh_.sample(first_ + i, u);
    s.pdf = 1 / area(0);
    return s;
}

std::optional<ShapeSample> TrianglePair::sample_from(std::uint32_t, Vec3 reference, Vec2 u) const {
    const std::array seen{seen_from(mesh_, first_, reference), seen_from(mesh_, first_ + 1, reference)};
    const float a = sampled_solid_angle(seen[0]), b = sampled_solid_angle(seen[1]);
    if (a == 0 || b == 0) return Shape::sample_from(0, reference, u);
    const std::uint32_t i = choose(a, b, u.x);
    return mesh_.sample_at(first_ + i, seen[i].sample(u), 1 / (a + b));
}

float TrianglePair::pdf_from(std::uint32_t, Vec3 reference, const Hit& hit, Vec3 wi) const {
    const float a = sampled_solid_angle(seen_from(mesh_, first_, reference)),
                b = sampled_solid_angle(seen_from(mesh_, first_ + 1, reference));
    return a == 0 || b == 0 ? Shape::pdf_from(0, reference, hit, wi) : 1 / (a + b);
}

} // namespace alhazen
