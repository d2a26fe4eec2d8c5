/// A ray prepared for box tests that never miss a box whose primitive the ray would hit.
///
/// The usual slab test enters and leaves a box at (plane - o) / d, axis by axis. Two kinds of rounding could
/// make it miss a box that is grazed, and a mesh would leak: its own, and that of a triangle test that moves
/// vertices to the ray's origin and shears them, which grows with the distance from the origin (Woop, Benthin
/// and Wald 2013, "Watertight Ray/Triangle Intersection", appendix). Both are covered by letting the ray
/// spread with distance: along each axis it enters with a velocity of |d| + k and leaves with |d| - k, where
/// k is a few units in the last place of the largest component. So the padding of a box is in proportion to
/// its distance, and costs nothing: there is one reciprocal for entries and one for exits. (Ize 2013, "Robust
/// BVH Ray Traversal", pads in proportion to the parameter t; that does not cover axes along which d is
/// small.) What a test loses over the extent of the primitive itself is in the box already: see padded_boxes.
#pragma once

#include <cmath>
#include <limits>

#include "base/bounds.h"
#include "base/ray.h"

namespace alhazen {

/// Whether the ray can hit anything: NaN, infinity, no direction and an empty interval are sorted out here.
inline bool is_traceable(const Ray& ray) {
    return is_finite(ray.o) && is_finite(ray.d) && (ray.d.x != 0 || ray.d.y != 0 || ray.d.z != 0) &&
           ray.tmax > 0;
}

/// Along each axis: a plane p is entered at p * enter_scale - enter_offset and left at p * leave_scale -
/// leave_offset; products and difference may be rounded once or twice. Never NaN for finite planes.
struct BoxRay {
    float enter_scale[3], enter_offset[3];
    float leave_scale[3], leave_offset[3];
    int near_side[3]; ///< 1 where the ray enters through the upper plane

    /// The ray must be traceable; scene contains all boxes.
    BoxRay(const Ray& ray, const Bounds3& scene) {
        const Vec3 d = abs(ray.d);
        const int main_axis = max_dimension(d);
        const float longest = d[main_axis];
        // Reciprocals of such directions overflow. They are not seen in scenes; all boxes are visited.
        const bool is_extreme = !(longest > 0x1p-100f && longest < 0x1p+100f);
        const float spread = 16 * unit * longest;
        const float reach = std::max(std::abs(scene.lo[main_axis] - ray.o[main_axis]),
                                     std::abs(scene.hi[main_axis] - ray.o[main_axis]));
        for (int axis = 0; axis < 3; ++axis) {
            // -0 counts as negative, as its reciprocal does.
            const bool negative = std::signbit(ray.d[axis]);
            near_side[axis] = negative;
            const float sign = negative ? -1.0f : 1.0f;
            float enter = sign / (d[axis] + spread);
            // An axis along which the ray hardly moves may never be left; there the padding is that of the
            // farthest point the ray can reach.
            const bool is_steady = d[axis] < 4 * spread;
            float leave = sign / std::max(d[axis] - spread, spread);
            float pad = 4 * unit * std::abs(ray.o[axis]);
            if (is_steady) pad += 32 * unit * reach;
            if (is_extreme) enter = leave = 0;
            enter_scale[axis] = enter;
            leave_scale[axis] = leave;
            enter_offset[axis] = finite((ray.o[axis] + sign * pad) * enter);
            leave_offset[axis] = is_extreme ? -largest : finite((ray.o[axis] - sign * pad) * leave);
        }
    }

    float enter(int axis, float plane) const { return plane * enter_scale[axis] - enter_offset[axis]; }
    float leave(int axis, float plane) const { return plane * leave_scale[axis] - leave_offset[axis]; }

    /// The interval of the ray, 0 to tmax, inside the box; the box is missed when entry > exit.
    struct Interval {
        float entry, exit;
        bool is_hit() const { return entry <= exit; }
    };
    Interval test(const Bounds3& box, float tmax) const {
        Interval t{0, tmax};
        for (int axis = 0; axis < 3; ++axis) {
            const bool upper = near_side[axis] != 0;
            t.entry = std::max(t.entry, enter(axis, upper ? box.hi[axis] : box.lo[axis]));
            t.exit = std::min(t.exit, leave(axis, upper ? box.lo[axis] : box.hi[axis]));
        }
        return t;
    }

  private:
    static constexpr float unit = 0x1p-24f;
    static constexpr float largest = std::numeric_limits<float>::max();
    static float finite(float v) { return std::min(std::max(v, -largest), largest); }
};

} // namespace alhazen
