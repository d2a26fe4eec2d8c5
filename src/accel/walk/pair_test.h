/// A ray against the two boxes of a binary node at once.
#pragma once

#include "accel/box_ray.h"
#include "accel/layout/binary.h"
#include "base/lanes.h"

namespace alhazen {

/// The ray against both children of a node at once.
class PairTest {
  public:
    explicit PairTest(const BoxRay& ray) {
        for (int axis = 0; axis < 3; ++axis) {
            near_side_[axis] = ray.near_side[axis];
            float enter = ray.enter_scale[axis], leave = ray.leave_scale[axis];
            scale_[axis] = Lanes4{enter, enter, -leave, -leave};
            float enter_offset = ray.enter_offset[axis], leave_offset = ray.leave_offset[axis];
            offset_[axis] = Lanes4{enter_offset, enter_offset, -leave_offset, -leave_offset};
        }
    }

    /// {entry of left, of right, -exit of left, -exit of right}, no earlier than 0 and no later than tmax. A
    /// child is hit when its entry <= its exit.
    Lanes4 operator()(const BinaryNode& node, float tmax) const {
        Lanes4 t = Lanes4{0, 0, -tmax, -tmax};
        for (int axis = 0; axis < 3; ++axis) {
            const int near = near_side_[axis];
            Lanes4 planes = join_pairs(node.slabs[axis][near], node.slabs[axis][1 - near]);
            t = max_lanes(planes * scale_[axis] - offset_[axis], t);
        }
        return t;
    }

  private:
    Lanes4 scale_[3], offset_[3];
    int near_side_[3];
};

} // namespace alhazen
