/// The hits of neighbouring pixels on one triangle: what is the same for all of them is kept.
#pragma once

#include "raster/draws.h"

namespace alhazen {

/// As TriangleMesh::surface, in single precision, for triangles in the scene itself.
class TriangleCache {
  public:
    void set(const PlacedSurface& surface, std::uint32_t triangle);

    bool has_normals() const { return has_normals_; }
    /// The geometric normal, where vertices have no normals.
    Vec3 normal() const { return ng_; }
    /// The geometric and the shading normal at a place on the triangle; those of the vertices decide which
    /// side is outside.
    struct Normals {
        Vec3 ng, ns;
    };
    Normals normals_at(Vec3 p) const { return normals(weights(p - a_)); }

    /// Where the line o + t d goes through; what is a little outside of the triangle is taken to its border.
    /// Fills all of the hit but p_error, t and time.
    void fill(Vec3 o, Vec3 d, Hit& hit);

  private:
    template <class T>
    const T& at_corner(const std::vector<T>& values, int i) const {
        return values[static_cast<std::size_t>(corner_[i])];
    }
    void find_weights();
    void find_common();
    /// Of the second and third corner, at a place relative to the first.
    Vec2 weights(Vec3 place) const {
        const float u = std::clamp(dot(place, to_u_), 0.0f, 1.0f);
        return {u, std::clamp(dot(place, to_v_), 0.0f, 1 - u)};
    }
    Normals normals(Vec2 weights) const;

    const PlacedSurface* surface_ = nullptr;
    const TriangleMesh* mesh_ = nullptr;
    bool has_normals_ = false;
    float outwards_ = 1; ///< -1 where the outside is on the other side of n_
    std::uint32_t triangle_ = 0;
    const int* corner_ = nullptr;
    Vec3 a_, ab_, ac_; ///< the first corner, and the ways to the others
    Vec3 n_, ng_;      ///< across the triangle; ng_ is of unit length, on the outside
    Vec3 to_u_, to_v_; ///< weights of the second and third corner, from the place relative to the first
    Vec3 ns_, ns_along_u_, ns_along_v_;

    bool has_common_ = false;
    Hit common_; ///< what all hits share
    Vec2 uv_, uv_along_u_, uv_along_v_;
};

} // namespace alhazen
