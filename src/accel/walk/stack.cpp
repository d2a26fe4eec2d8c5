/// The baseline walk: binary nodes, depth first, the nearer child first, the farther one put on a stack.
#include "accel/list.h"
#include "accel/walk/pair_test.h"
#include "accel/walk/walk_structure.h"

namespace alhazen {

namespace {

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
