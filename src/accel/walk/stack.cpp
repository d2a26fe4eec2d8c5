/// The baseline walk: binary nodes, depth first, the nearer child first, the farther one put on a stack.
#include "accel/layout/binary.h"
#include "accel/list.h"
#include "accel/walk/walk_structure.h"
#include "base/lanes.h"

namespace alhazen {

namespace {

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

struct StackWalk {
    using Layout = BinaryLayout;

    template <Query query, class Counter>
    static void walk(const BinaryLayout& layout, const BoxRay& ray, Nearest<query>& nearest,
                     Counter& counter) {
        // Without defaults, since setting the whole stack to zero would take longer than a short walk.
        struct Entry {
            BinaryChild child;
            float t;
        };
        Entry stack[Tree::max_depth];
        int height = 0;
        const PairTest test(ray);
        BinaryChild current = layout.root;
        for (;;) {
            if (current.count > 0) {
                counter.leaf();
                if (nearest.test(current.index, current.count)) return;
            } else {
                counter.node();
                const BinaryNode& node = layout.nodes[current.index];
                Lanes4 t = test(node, nearest.tmax());
                bool left = t[0] <= -t[2], right = t[1] <= -t[3];
                if (left && right) {
                    int far = t[1] < t[0] ? 0 : 1;
                    stack[height++] = {node.child(far), far ? t[1] : t[0]};
                    counter.stack(height);
                    current = node.child(1 - far);
                    continue;
                }
                if (left || right) {
                    current = node.child(right);
                    continue;
                }
            }
            do {
                if (height == 0) return;
                --height;
            } while (stack[height].t > nearest.tmax());
            current = stack[height].child;
        }
    }
};

std::unique_ptr<Structure> make(const Primitives& primitives, const Tree& tree, const WalkOptions&) {
    return std::make_unique<WalkStructure<StackWalk>>(primitives, tree, BinaryLayout(tree));
}

} // namespace

AccelWalk stack_walk() {
    return {"stack", "binary nodes, nearer child first, an ordinary stack", {}, make};
}

} // namespace alhazen
