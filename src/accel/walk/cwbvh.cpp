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
#include "accel/list.h"
#include "accel/walk/compressed_structure.h"
#include "accel/walk/compressed_test.h"

namespace alhazen {

namespace {

/// Children of one node that were hit: nodes in bits 24 ... 31 with the node's inner_mask in bits 0 ... 7, or
/// primitives in bits 0 ... 23.
struct Group {
    std::uint32_t base, mask;
    bool has_nodes() const { return mask > 0x00ffffff; }
};

/// A slot's bit among the nodes of a group is 24 + (slot ^ octant).
class GroupTest {
  public:
    explicit GroupTest(const BoxRay& ray) : test_(ray) {}

    std::uint32_t octant() const { return test_.octant(); }
    /// Nodes that are hit in bits 24 ... 31, primitives of leaves that are hit in bits 0 ... 23.
    template <class Counter>
    std::uint32_t operator()(const CompressedNode& node, float tmax, Counter& counter) const {
        std::uint32_t mask = 0;
        for (int first = 0; first < CompressedNode::slots; first += 4) {
            const IntLanes4 hit = test_(node, first, tmax).is_hit;
            for (int i = 0; i < 4; ++i) {
                if (!hit[i]) continue;
                const std::uint32_t meta = node.meta[first + i];
                std::uint32_t place = meta & 31;
                if (place >= 24)
                    place ^= octant();
                else if (meta != 0)
                    counter.leaf();
                mask |= (meta >> 5) << place; // nothing for an empty slot
            }
        }
        return mask;
    }

  private:
    CompressedTest test_;
};

struct CompressedWalk {
    using Layout = CompressedLayout;

    template <Query query, class Counter>
    static void walk(const CompressedLayout& layout, const BoxRay& ray, Nearest<query>& nearest,
                     Counter& counter) {
        const GroupTest test(ray);
        Group stack[CollapsedTree::max_depth];
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
    return make_compressed<CompressedWalk>(primitives, tree);
}

} // namespace

AccelWalk cwbvh_walk() {
    return {"cwbvh", "nodes of 8 in 80 bytes, visited by octant (Ylitie, Karras and Laine 2017)",
            BuildOptions{.leaf_size = 1}, make};
}

} // namespace alhazen
