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
#include "base/lanes.h"
#include "base/ray.h"

namespace alhazen {

/// Whether the ray can hit anything: NaN, infinity, no direction and an empty interval are sorted out here.
inline bool is_traceable(const Ray& ray) {
    // What is not finite becomes NaN, which stays.
    float all = (ray.o.x - ray.o.x) + (ray.o.y - ray.o.y) + (ray.o.z - ray.o.z) + (ray.d.x - ray.d.x) +
                (ray.d.y - ray.d.y) + (ray.d.z - ray.d.z);
    return all == 0 && (ray.d.x != 0 || ray.d.y != 0 || ray.d.z != 0) && ray.tmax > 0;
}

/// Along each axis: a plane p is entered at p * enter_scale - enter_offset and left at p * leave_scale -
/// leave_offset; products and difference may be rounded once or twice. Never NaN for finite planes. The
/// fourth lane means nothing.
struct BoxRay {
    Lanes4 enter_scale, enter_offset;
    Lanes4 leave_scale, leave_offset;
    IntLanes4 near_side; ///< 1 where the ray enters through the upper plane

    /// The ray must be traceable; scene contains all boxes.
    BoxRay(const Ray& ray, const Bounds3& scene) {
        const Lanes4 o = to_lanes(ray.o), d = to_lanes(ray.d);
        // -0 counts as negative, as its reciprocal does.
        const IntLanes4 sign = lane_bits(d) & sign_bit;
        near_side = (sign >> 31) & 1;
        const Lanes4 speed = magnitude(d);
        const float longest = std::max(std::max(speed[0], speed[1]), speed[2]);
        const Lanes4 spread = all_lanes(16 * unit * longest);
        // An axis along which the ray hardly moves may never be left; there the padding is that of the
        // farthest point the ray can reach.
        const Lanes4 far = max_lanes(magnitude(to_lanes(scene.lo) - o), magnitude(to_lanes(scene.hi) - o));
        const float reach = std::max(std::max(far[0], far[1]), far[2]);
        const Lanes4 steady_pad = all_lanes(32 * unit * reach);
        const Lanes4 pad = 4 * unit * magnitude(o) + (speed < 4 * spread ? steady_pad : all_lanes(0));
        const Lanes4 backward = with_sign(pad, sign);
        enter_scale = with_sign(1 / (speed + spread), sign);
        leave_scale = with_sign(1 / max_lanes(speed - spread, spread), sign);
        enter_offset = finite((o + backward) * enter_scale);
        leave_offset = finite((o - backward) * leave_scale);
        // Reciprocals of such directions overflow. They are not seen in scenes; all boxes are visited.
        if (!(longest > 0x1p-100f && longest < 0x1p+100f)) [[unlikely]] {
            enter_scale = enter_offset = leave_scale = all_lanes(0);
            leave_offset = all_lanes(-largest);
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
    static constexpr int sign_bit = std::numeric_limits<int>::min();

    static IntLanes4 lane_bits(Lanes4 v) { return std::bit_cast<IntLanes4>(v); }
    static Lanes4 magnitude(Lanes4 v) { return std::bit_cast<Lanes4>(lane_bits(v) & ~sign_bit); }
    static Lanes4 with_sign(Lanes4 v, IntLanes4 sign) { return std::bit_cast<Lanes4>(lane_bits(v) ^ sign); }
    static Lanes4 finite(Lanes4 v) {
        return min_lanes(max_lanes(v, all_lanes(-largest)), all_lanes(largest));
    }
};

} // namespace alhazen
