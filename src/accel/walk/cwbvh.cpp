/// A walk through compressed wide nodes: Ylitie, Karras and Laine 2017, "Efficient Incoherent Ray Traversal
/// on GPUs Through Compressed Wide BVHs", section 5.
///
/// Memory traffic is what incoherent rays wait for, so nodes are packed (see layout/compressed.h) and so is
/// the stack: an entry of 8 bytes is a group, all children of one node that were hit and are still to be
/// visited, as a base and a mask. Bits 24 ... 31 of a group's mask are the children that are nodes, bit 24 +
/// (slot ^ octant of the ray), so that the highest bit is the next in the ray's order; bits 0 ... 23 are
/// primitives. Picture: what waits on the stack are not boxes but half-opened drawers.
///
/// What becomes of it on a CPU: a node is tested as two times four lanes instead of by one thread with packed
/// bytes. On a GPU a warp whose threads find primitives at different times puts groups of them on the stack
/// until enough threads have some; one ray alone has nobody to wait for, so primitives are tested at once.
/// The article moves the ray into each node's grid, which takes one multiplication less but rounds by the
/// node's size, not by what is in BoxRay; planes are put back where they were instead, and meshes do not
/// leak. Lost is the sorting by distance: the fixed order visits more nodes than a sorted one, and a group
/// waits without its distances. Smaller nodes remain an advantage wherever the tree exceeds the caches.
#include "accel/layout/compressed.h"
#include "accel/list.h"
#include "accel/walk/walk_structure.h"
#include "base/lanes.h"

namespace alhazen {

namespace {

/// Children of one node that were hit: nodes in bits 24 ... 31 with the node's inner_mask in bits 0 ... 7, or
/// primitives in bits 0 ... 23.
struct Group {
    std::uint32_t base, mask;
    bool has_nodes() const { return mask > 0x00ffffff; }
};

Lanes4 to_floats(const std::uint8_t* from) {
    using Bytes4 = std::uint8_t __attribute__((vector_size(4)));
    Bytes4 bytes;
    std::memcpy(&bytes, from, sizeof bytes);
    return __builtin_convertvector(__builtin_convertvector(bytes, IntLanes4), Lanes4);
}

class CompressedTest {
  public:
    explicit CompressedTest(const BoxRay& ray) : ray_(ray) {
        for (int axis = 0; axis < 3; ++axis)
            if (!ray.near_side[axis]) octant_ |= 1u << axis;
    }

    /// A slot's bit among the nodes of a group is 24 + (slot ^ octant).
    std::uint32_t octant() const { return octant_; }

    /// Nodes that are hit in bits 24 ... 31, primitives of leaves that are hit in bits 0 ... 23.
    template <class Counter>
    std::uint32_t operator()(const CompressedNode& node, float tmax, Counter& counter) const {
        std::uint32_t mask = 0;
        for (int first = 0; first < CompressedNode::slots; first += 4) {
            const IntLanes4 hit = test_four(node, first, tmax);
            for (int i = 0; i < 4; ++i) {
                if (!hit[i]) continue;
                const std::uint32_t meta = node.meta[first + i];
                std::uint32_t place = meta & 31;
                if (place >= 24)
                    place ^= octant_;
                else if (meta != 0)
                    counter.leaf();
                mask |= (meta >> 5) << place; // nothing for an empty slot
            }
        }
        return mask;
    }

  private:
    IntLanes4 test_four(const CompressedNode& node, int first, float tmax) const {
        Lanes4 entry = all_lanes(0), exit = all_lanes(tmax);
        for (int axis = 0; axis < 3; ++axis) {
            const int near = ray_.near_side[axis];
            const float step = node.step(axis), origin = node.origin[axis];
            const Lanes4 in = to_floats(node.planes[near][axis] + first) * step + origin;
            const Lanes4 out = to_floats(node.planes[1 - near][axis] + first) * step + origin;
            entry = max_lanes(in * ray_.enter_scale[axis] - ray_.enter_offset[axis], entry);
            exit = min_lanes(out * ray_.leave_scale[axis] - ray_.leave_offset[axis], exit);
        }
        return entry <= exit;
    }

    BoxRay ray_;
    std::uint32_t octant_ = 0;
};

struct CompressedWalk {
    using Layout = CompressedLayout;

    template <Query query, class Counter>
    static void walk(const CompressedLayout& layout, const BoxRay& ray, Nearest<query>& nearest,
                     Counter& counter) {
        const CompressedTest test(ray);
        Group stack[WideTree::max_depth];
        int height = 0;
        Group nodes{0, 0x80000000u}; // the root, as the only child of nothing
        for (;;) {
            const int bit = 31 - std::countl_zero(nodes.mask);
            const int slot = (bit - 24) ^ static_cast<int>(test.octant());
            nodes.mask &= ~(1u << bit);
            const std::uint32_t before = nodes.mask & 0xff & ((1u << slot) - 1);
            const std::uint32_t number = nodes.base + static_cast<std::uint32_t>(std::popcount(before));
            if (nodes.has_nodes()) {
                stack[height++] = nodes;
                counter.stack(height);
            }
            counter.node();
            const CompressedNode& node = layout.nodes[number];
            const std::uint32_t hits = test(node, nearest.tmax(), counter);
            nodes = {node.first_child, (hits & 0xff000000u) | node.inner_mask};
            for (Group primitives{node.first_primitive, hits & 0x00ffffffu}; primitives.mask != 0;
                 primitives.mask &= primitives.mask - 1) {
                const int place = std::countr_zero(primitives.mask);
                if (nearest.test(primitives.base + static_cast<std::uint32_t>(place), 1)) return;
            }
            if (nodes.has_nodes()) continue;
            if (height == 0) return;
            nodes = stack[--height];
        }
    }
};

std::unique_ptr<Structure> make(const Primitives& primitives, const Tree& tree, const WalkOptions&) {
    CompressedLayout layout(tree);
    // Leaves are found in the layout's own order.
    Tree rearranged;
    if (!tree.nodes.empty()) rearranged.nodes.push_back(tree.nodes[0]);
    rearranged.order = std::move(layout.order);
    return std::make_unique<WalkStructure<CompressedWalk>>(primitives, rearranged, std::move(layout));
}

} // namespace

AccelWalk cwbvh_walk() {
    return {"cwbvh", "nodes of 8 in 80 bytes, visited by octant (Ylitie, Karras and Laine 2017)",
            BuildOptions{.leaf_size = 1}, make};
}

} // namespace alhazen
