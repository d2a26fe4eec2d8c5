/// Bilinear patches over shared vertices, in world space. The kinds that give patches (bilinearmesh, plymesh)
/// fill it.
#pragma once

#include <string>
#include <vector>

#include "shapes/bilinear_patch.h"
#include "shapes/mesh_arrays.h"
#include "shapes/shape.h"

namespace alhazen {

struct BilinearMesh : Shape {
    std::vector<Vec3> P;      ///< positions
    std::vector<Vec3> N;      ///< normals, one a vertex, or none; not unit length
    std::vector<Vec2> uv;     ///< one a vertex, or none: then the unit square for each patch
    std::vector<int> indices; ///< four a patch, each valid: corners (0,0), (1,0), (0,1), (1,1)

    std::uint32_t primitive_count() const final { return static_cast<std::uint32_t>(indices.size() / 4); }
    Bounds3 bounds(std::uint32_t patch) const final;
    bool intersect(const Ray& ray, std::uint32_t patch, Intersection& hit) const final;
    Hit surface(const Ray& ray, std::uint32_t patch, const Intersection& met) const final;
    float area(std::uint32_t patch) const final { return static_cast<float>(geometry(patch).area()); }
    ShapeSample sample(std::uint32_t patch, Vec2 u) const final;
    NormalCone normals(std::uint32_t patch) const final;
    bool tessellate(double tolerance, const TriangleSink& out) const final;
    std::size_t bytes() const final {
        return sizeof *this + array_bytes(P) + array_bytes(N) + array_bytes(uv) + array_bytes(indices);
    }

  protected:
    /// Checks the arrays against each other, takes them to world space and sets the orientation. Adds errors
    /// at the place, each beginning with prefix.
    void prepare(const Place& place, const std::string& prefix, BuildContext& context);

  private:
    std::size_t corner(std::uint32_t patch, int i) const {
        return static_cast<std::size_t>(indices[std::size_t{4} * patch + static_cast<std::size_t>(i)]);
    }
    BilinearPatch geometry(std::uint32_t patch) const {
        return {Vec3d(P[corner(patch, 0)]), Vec3d(P[corner(patch, 1)]), Vec3d(P[corner(patch, 2)]),
                Vec3d(P[corner(patch, 3)])};
    }
    template <class V>
    V interpolate(const std::vector<V>& values, std::uint32_t patch, Vec2 at) const {
        V low = lerp(at.x, values[corner(patch, 0)], values[corner(patch, 1)]);
        V high = lerp(at.x, values[corner(patch, 2)], values[corner(patch, 3)]);
        return lerp(at.y, low, high);
    }
    Vec3 outward(std::uint32_t patch, const BilinearPatch& g, Vec2 at) const;
    Vec3 point_error(std::uint32_t patch, Vec3d p) const;
    void set_tangents(std::uint32_t patch, const BilinearPatch& g, Vec2 at, Hit& hit) const;

    bool is_turned_ = false;
};

} // namespace alhazen
