/// The ray against two boxes at once, never missing a box whose primitive the ray would hit.
///
/// The usual slab test enters and leaves a box at (plane - o) / d, axis by axis. Rounding could make it miss
/// a box that is grazed, and a mesh would leak. Two paddings prevent that: the exit is taken 2 gamma(3)
/// later, for the rounding of the test itself (Ize 2013, "Robust BVH Ray Traversal"); and the origin is moved
/// by a few units in the last place of the scene's extent seen from it, against the direction for the entry
/// and along it for the exit, for the rounding of a triangle test that moves vertices to the ray's origin and
/// shears them (Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection", appendix). With both,
/// every structure finds exactly the hits that testing each primitive finds.
#pragma once

#include "accel/layout/binary.h"
#include "base/lanes.h"
#include "base/ray.h"

namespace alhazen {

/// Whether the ray can hit anything: NaN, infinity, no direction and an empty interval are sorted out here.
inline bool is_traceable(const Ray& ray) {
    return is_finite(ray.o) && is_finite(ray.d) && (ray.d.x != 0 || ray.d.y != 0 || ray.d.z != 0) &&
           ray.tmax > 0;
}

/// A ray prepared for box tests; it must be traceable.
class SlabRay {
  public:
    SlabRay(const Ray& ray, const Bounds3& scene) {
        Vec3 reach = max(abs(scene.lo - ray.o), abs(scene.hi - ray.o));
        float along = reach[max_dimension(abs(ray.d))];
        for (int axis = 0; axis < 3; ++axis) {
            // -0 counts as negative, as its reciprocal does.
            bool negative = std::signbit(ray.d[axis]);
            near_side_[axis] = negative;
            // Eight roundings: Woop et al. count five, the rest is for the products here.
            float pad = 8 * 0x1p-24f * (reach[axis] + along);
            if (negative) pad = -pad;
            float o = ray.o[axis], inverse = 1 / ray.d[axis];
            origin_[axis] = Lanes4{o + pad, o + pad, o - pad, o - pad};
            float late = -inverse * (1 + 2 * gamma_bound(3));
            inverse_[axis] = Lanes4{inverse, inverse, late, late};
        }
    }

    /// {entry of left, of right, -exit of left, -exit of right}, no earlier than 0 and no later than tmax. A
    /// child is hit when its entry <= its exit. A NaN (0 x infinity: the ray runs inside a slab's plane)
    /// bounds nothing.
    Lanes4 test(const BinaryNode& node, float tmax) const {
        Lanes4 t = Lanes4{0, 0, -tmax, -tmax};
        for (int axis = 0; axis < 3; ++axis) {
            const int near = near_side_[axis];
            Lanes4 planes = join_pairs(node.slabs[axis][near], node.slabs[axis][1 - near]);
            t = max_lanes((planes - origin_[axis]) * inverse_[axis], t);
        }
        return t;
    }

  private:
    Lanes4 origin_[3], inverse_[3];
    int near_side_[3];
};

} // namespace alhazen
