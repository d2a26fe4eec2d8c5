/// The hits of neighbouring pixels on one triangle: what is the same for all of them is kept.
#pragma once

#include "raster/draws.h"

namespace alhazen {

/// As TriangleMesh::surface, in single precision, for triangles in the scene itself.
class TriangleCache {
  public:
    void set(const PlacedSurface& surface, std::uint32_t triangle);
    /// Where the line o + t d goes through; what is a little outside of the triangle is taken to its border.
    /// Fills all of the hit but p_error, t and time.
    void fill(Vec3 o, Vec3 d, Hit& hit) const;

  private:
    Hit common_;       ///< what all hits share
    Vec3 a_;           ///< the first corner
    Vec3 n_;           ///< across the triangle, not of unit length
    Vec3 to_u_, to_v_; ///< weights of the second and third corner, from the place relative to the first
    Vec2 uv_, uv_along_u_, uv_along_v_;
    Vec3 ns_, ns_along_u_, ns_along_v_;
    bool has_normals_ = false;
};

} // namespace alhazen
