/// Where in a triangle a ray goes through that the rasteriser says meets it.
#pragma once

#include "shapes/triangle_mesh.h"

namespace alhazen {

/// As TriangleMesh::intersect would, for a ray that meets the triangle but for rounding: what is a little
/// outside is taken to the border (Moeller and Trumbore 1997).
inline Intersection point_of_triangle(const TriangleMesh& mesh, std::uint32_t triangle, const Ray& ray) {
    auto [pa, pb, pc] = mesh.vertices(triangle);
    const Vec3d a(pa), o(ray.o), d(ray.d), ab = Vec3d(pb) - a, ac = Vec3d(pc) - a, s = o - a;
    const Vec3d n = cross(d, ac), m = cross(s, ab);
    const double determinant = dot(ab, n), scale = determinant != 0 ? 1 / determinant : 0;
    const double u = std::clamp(dot(s, n) * scale, 0.0, 1.0);
    const double v = std::clamp(dot(d, m) * scale, 0.0, 1.0 - u);
    Intersection met;
    met.t = static_cast<float>(dot(ac, m) * scale);
    met.u = static_cast<float>(u);
    met.v = static_cast<float>(v);
    return met;
}

} // namespace alhazen
