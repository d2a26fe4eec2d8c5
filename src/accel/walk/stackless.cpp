/// A walk without a stack: Binder and Keller 2016, "Efficient Stackless Hierarchy Traversal on GPUs with
/// Backtracking in Constant Time".
///
/// The walk remembers two numbers: the key of the node it is at (a bit a level, left or right) and the trail
/// (a bit a level, set where the other child was hit too and is still to be visited). To go back is
/// arithmetic: the lowest set bit of the trail says how many levels up, the key cut there with its last bit
/// flipped is the key of the node to visit, and a perfect hash leads from the key to the node. However deep
/// the tree, that takes the same time. Often the node to go back to is the one that was put off last; where
/// that is, is kept, and the hash is asked only for those before it. Keys and trail have 128 bits, since
/// trees may be 96 levels deep; the article's have 32 or 64.
///
/// On a GPU stacks of thousands of rays compete for little fast memory, and to have none frees it. A CPU
/// keeps a stack in its first cache, where a push is nearly free; the hash's two dependent look-ups, in
/// tables as large as the tree, are not. Lost, too, are the distances a stack could keep beside the nodes: a
/// child put off is visited even if a nearer hit was found meanwhile. What remains is the least state a ray
/// can have, 40 bytes whatever the tree.
#include "accel/layout/hashed.h"
#include "accel/list.h"
#include "accel/walk/pair_test.h"
#include "accel/walk/walk_structure.h"

namespace alhazen {

namespace {

struct StacklessWalk {
    using Layout = HashedLayout;

    template <Query query, class Counter>
    static void walk(const HashedLayout& layout, const BoxRay& ray, Nearest<query>& nearest,
                     Counter& counter) {
        const PairTest test(ray);
        BinaryChild current = layout.binary.root;
        BinaryChild postponed; // the last one; known until it is visited
        bool is_known = false;
        PathBits key = 1, trail = 0;
        for (;;) {
            if (current.count > 0) {
                counter.leaf();
                if (nearest.test(current.index, current.count)) return;
            } else {
                counter.node();
                const BinaryNode& node = layout.binary.nodes[current.index];
                const Lanes4 t = test(node, nearest.tmax());
                const bool left = t[0] <= -t[2], right = t[1] <= -t[3];
                if (left || right) {
                    const bool both = left && right;
                    const int side = both ? t[1] < t[0] : right;
                    trail = trail << 1 | static_cast<PathBits>(both);
                    key = key << 1 | static_cast<PathBits>(side);
                    current = node.child(side);
                    if (both) {
                        postponed = node.child(1 - side);
                        is_known = true;
                    }
                    continue;
                }
            }
            if (trail == 0) return;
            const int levels = trailing_zeros(trail);
            trail = trail >> levels ^ 1;
            key = key >> levels ^ 1;
            current = is_known ? postponed : layout.by_path.find(key);
            is_known = false;
        }
    }
};

std::unique_ptr<Structure> make(const Primitives& primitives, const Tree& tree, const WalkOptions&) {
    return std::make_unique<WalkStructure<StacklessWalk>>(primitives, tree, HashedLayout(tree));
}

} // namespace

AccelWalk stackless_walk() {
    return {"stackless",
            "binary nodes found by a perfect hash of their paths (Binder and Keller 2016)",
            {},
            make};
}

} // namespace alhazen
