/// Triangles over shared vertices, in world space. The kinds that give triangles (trianglemesh, plymesh) fill
/// it.
#pragma once

#include <array>
#include <vector>

#include "accel/triangle.h"
#include "shapes/mesh_arrays.h"
#include "shapes/shape.h"

namespace alhazen {

struct TriangleMesh : Shape {
    std::vector<Vec3> P;      ///< positions
    std::vector<Vec3> N;      ///< normals, one a vertex, or none; not unit length
    std::vector<Vec3> S;      ///< tangents, one a vertex, or none
    std::vector<Vec2> uv;     ///< one a vertex, or none: then (0,0), (1,0), (1,1) for each triangle
    std::vector<int> indices; ///< three a triangle, each valid

    std::array<Vec3, 3> vertices(std::uint32_t triangle) const {
        const int* i = corner_indices(triangle);
        return {P[static_cast<std::size_t>(i[0])], P[static_cast<std::size_t>(i[1])],
                P[static_cast<std::size_t>(i[2])]};
    }

    const int* corner_indices(std::uint32_t triangle) const {
        return indices.data() + std::size_t{3} * triangle;
    }
    /// Whether normals point against the order of the corners, where there are no vertex normals.
    bool is_turned() const { return is_turned_; }

    std::uint32_t primitive_count() const final { return static_cast<std::uint32_t>(indices.size() / 3); }
    Bounds3 bounds(std::uint32_t triangle) const final;
    bool intersect(const Ray& ray, std::uint32_t triangle, Intersection& hit) const final {
        return intersect_with(ray, RayShear(ray), triangle, hit);
    }
    /// As intersect, with the ray's shear made once for many triangles, and without a virtual call.
    bool intersect_with(const Ray& ray, const RayShear& shear, std::uint32_t triangle,
                        Intersection& hit) const {
        auto [a, b, c] = vertices(triangle);
        return intersect_triangle(ray, shear, a, b, c, hit);
    }
    Hit surface(const Ray& ray, std::uint32_t triangle, const Intersection& met) const final;
    Hit plain_surface(const Ray& ray, std::uint32_t triangle, const Intersection& met) const final;
    NormalChange normal_change(const Hit& hit) const final;
    float area(std::uint32_t triangle) const final;
    ShapeSample sample(std::uint32_t triangle, Vec2 u) const final;
    std::optional<ShapeSample> sample_from(std::uint32_t triangle, Vec3 reference, Vec2 u) const final;
    float pdf_from(std::uint32_t triangle, Vec3 reference, const Hit& hit, Vec3 wi) const final;
    NormalCone normals(std::uint32_t triangle) const final;
    /// The point with these weights of the second and third corner, and the density as given.
    ShapeSample sample_at(std::uint32_t triangle, Vec2 weights, float pdf) const;
    const TriangleMesh* triangles() const final { return this; }
    std::size_t bytes() const final {
        return sizeof *this + array_bytes(P) + array_bytes(N) + array_bytes(S) + array_bytes(uv) +
               array_bytes(indices);
    }

  protected:
    /// Checks the arrays against each other, takes them to world space and sets the orientation. Adds errors
    /// at the place, each beginning with prefix.
    void prepare(const Place& place, const std::string& prefix, BuildContext& context);

  private:
    std::array<Vec2, 3> corner_uv(std::uint32_t triangle) const;
    // The normal n by the order of the corners, at unit length, turned over where the mesh is.
    Vec3d oriented(Vec3d n) const;
    Vec3d face_normal(std::uint32_t triangle) const;
    // Weighted by b; zero when the mesh has no normals.
    Vec3d vertex_normal(std::uint32_t triangle, Vec3d b) const;
    struct Sides;
    // Without uv and tangents.
    Hit plain_hit(const Ray& ray, std::uint32_t triangle, const Intersection& met, const Sides& sides) const;
    static void set_tangents(Hit& hit, Vec3d ab, Vec3d ac, Vec2d uv_ab, Vec2d uv_ac);
    /// tangent: the mesh's own; zero if it has none.
    static void set_shading_tangents(Hit& hit, Vec3 tangent);

    bool is_turned_ = false;
};

} // namespace alhazen
