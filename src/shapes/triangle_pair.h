/// Two neighbours of a mesh that lie in one plane, as one light: most rectangular lamps are two triangles.
#pragma once

#include <memory>

#include "shapes/triangle_mesh.h"

namespace alhazen {

/// One primitive. Points are chosen on both triangles by how large each is seen, so that they are spread over
/// the pair as over one surface, and nobody has to guess which triangle gives more light.
class TrianglePair final : public Shape {
  public:
    /// Triangles first and first + 1 of the mesh, which must outlive the pair.
    TrianglePair(const TriangleMesh& mesh, std::uint32_t first);
    /// The same; nullptr where the two do not share an edge, or do not face the same way.
    static std::unique_ptr<TrianglePair> make(const TriangleMesh& mesh, std::uint32_t first);

    Bounds3 bounds(std::uint32_t) const override;
    bool intersect(const Ray& ray, std::uint32_t, Intersection& hit) const override;
    Hit surface(const Ray& ray, std::uint32_t, const Intersection& met) const override;
    float area(std::uint32_t) const override { return areas_[0] + areas_[1]; }
    ShapeSample sample(std::uint32_t, Vec2 u) const override;
    std::optional<ShapeSample> sample_from(std::uint32_t, Vec3 reference, Vec2 u) const override;
    float pdf_from(std::uint32_t, Vec3 reference, const Hit& hit, Vec3 wi) const override;
    NormalCone normals(std::uint32_t) const override { return mesh_.normals(first_); }
    std::size_t bytes() const override { return sizeof *this; }

  private:
    const TriangleMesh& mesh_;
    std::uint32_t first_;
    std::array<float, 2> areas_;
};

} // namespace alhazen
