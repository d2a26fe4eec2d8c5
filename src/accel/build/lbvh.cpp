/// Builds trees by sorting primitives along a curve.
///
/// Karras 2012, "Maximizing Parallelism in the Construction of BVHs, Octrees, and k-d Trees" (after
/// Lauterbach et al. 2009, "Fast BVH Construction on GPUs"): the centroids' Morton codes are sorted; their
/// radix tree is the hierarchy, split wherever space is halved; boxes are joined from the leaves up. No cost
/// is computed on the way down, so the tree is made faster than any other and is worse than most. On the way
/// up the surface area heuristic still decides which small subtrees are better off as one leaf.
///
/// The method was made for GPUs: one thread a node in each pass. On a CPU each pass is a loop over runs of
/// nodes, and the passes' going to and fro through memory, which a GPU's bandwidth hides, becomes what they
/// cost; see also radix_tree.h. The order of nodes in memory, left to chance there, is depth-first here: the
/// sizes of the subtrees, counted on the way up, say where each goes.
#include "accel/build/lbvh.h"

#include <cstring>

#include "accel/build/radix_tree.h"
#include "accel/list.h"
#include "base/lanes.h"

namespace alhazen {

namespace {

// Subtrees of so many primitives are worth a task of their own.
constexpr std::uint32_t task_size = 16384;
// How far ahead of use boxes are fetched: they are read in the curve's order, not in memory's.
constexpr std::size_t fetch_ahead = 16;

// A box as six floats in a row, lower corner first, wherever they stand: the first four and the last four are
// two registers, of which three lanes each count.
struct BoxLanes {
    Lanes4 lo; // x y z -
    Lanes4 hi; // - x y z

    explicit BoxLanes(const float* box) {
        std::memcpy(&lo, box, sizeof lo);
        std::memcpy(&hi, box + 2, sizeof hi);
    }
    void extend(const BoxLanes& b) {
        lo = min_lanes(b.lo, lo);
        hi = max_lanes(b.hi, hi);
    }
    void store(float* box) const {
        std::memcpy(box, &lo, 3 * sizeof(float));
        for (int axis = 0; axis < 3; ++axis) box[3 + axis] = hi[axis + 1];
    }
    float half_area() const {
        const float x = hi[1] - lo[0], y = hi[2] - lo[1], z = hi[3] - lo[2];
        return x * y + y * z + z * x;
    }
};
static_assert(sizeof(Bounds3) == 6 * sizeof(float));

// What an inner node of the radix tree will be.
struct Subtree {
    float box[6];
    float cost;          // area times tests
    std::uint32_t nodes; // how many of the tree's nodes it takes

    Bounds3 bounds() const { return {{box[0], box[1], box[2]}, {box[3], box[4], box[5]}}; }
};

class LbvhBuilder {
  public:
    LbvhBuilder(std::span<const Bounds3> boxes, std::span<const MortonKey> keys, const BuildOptions& options,
                BigArray<MortonKey>&& scratch)
        : boxes_(boxes), keys_(keys), options_(options), radix_(keys, std::move(scratch)),
          subtrees_(radix_.inner()) {}

    Tree build() {
        radix_.bottom_up([this](std::size_t leaf) { fetch(leaf + fetch_ahead); },
                         [this](std::uint32_t i, RadixTree::Node n) { fit(i, n); });
        Tree tree;
        resize(tree.order, keys_.size());
        parallel_ranges(keys_.size(), task_size, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) tree.order[i] = keys_[i].index;
        });
        resize(tree.nodes, radix_.inner() ? subtrees_[0].nodes : 1);
        radix_.inner() ? place(tree.nodes.data(), 0, 0) : place_leaf(tree.nodes.data(), 0, 0);
        return tree;
    }

  private:
    template <class T>
    static void resize(std::vector<T>& v, std::size_t size) {
        v.reserve(size);
        prefer_huge_pages(v.data(), size * sizeof(T));
        v.resize(size);
    }

    void fetch(std::size_t leaf) const {
        if (leaf < keys_.size()) __builtin_prefetch(&boxes_[keys_[leaf].index]);
    }

    // A child in registers, read without a branch: which of the two kinds it is, no processor guesses.
    struct Child {
        BoxLanes box;
        float cost;
        std::uint32_t nodes;
    };
    Child child(std::uint32_t number, bool is_leaf) const {
        const Subtree& subtree = subtrees_[is_leaf ? 0 : number];
        const float* leaf_box = &boxes_[keys_[number].index].lo.x;
        Child c{BoxLanes(is_leaf ? leaf_box : subtree.box), subtree.cost, subtree.nodes};
        const float area = c.box.half_area();
        c.cost = is_leaf ? area : c.cost;
        c.nodes = is_leaf ? 1 : c.nodes;
        return c;
    }

    void fit(std::uint32_t i, RadixTree::Node n) {
        const Child l = child(n.split, n.split == n.first), r = child(n.split + 1, n.split + 1 == n.last);
        BoxLanes box = l.box;
        box.extend(r.box);
        const float area = box.half_area();
        const float split_cost = area * options_.node_cost + (l.cost + r.cost);
        const std::uint32_t tests = (n.count() + options_.block - 1) / options_.block;
        const float leaf_cost = area * static_cast<float>(tests);
        const bool is_leaf =
            n.count() <= std::min(options_.leaf_size, Tree::max_leaf_size) && leaf_cost <= split_cost;
        Subtree& s = subtrees_[i];
        box.store(s.box);
        s.cost = is_leaf ? leaf_cost : split_cost;
        s.nodes = is_leaf ? 1 : 1 + l.nodes + r.nodes;
    }

    void place_leaf(Tree::Node* nodes, std::uint32_t leaf, std::uint32_t at) const {
        nodes[at] = {boxes_[keys_[leaf].index], leaf, 1};
    }
    // Writes the subtree of an inner node to the places from at on.
    void place(Tree::Node* nodes, std::uint32_t i, std::uint32_t at) const {
        for (;;) {
            const RadixTree::Node n = radix_.node(i);
            const Subtree& s = subtrees_[i];
            if (s.nodes == 1) {
                nodes[at] = {s.bounds(), n.first, n.count()};
                return;
            }
            const bool left_is_leaf = n.split == n.first, right_is_leaf = n.split + 1 == n.last;
            const std::uint32_t right = at + 1 + (left_is_leaf ? 1 : subtrees_[n.split].nodes);
            nodes[at] = {s.bounds(), right, 0};
            if (n.count() > task_size && !left_is_leaf && !right_is_leaf) {
                parallel_invoke([&] { place(nodes, n.split, at + 1); },
                                [&] { place(nodes, n.split + 1, right); });
                return;
            }
            left_is_leaf ? place_leaf(nodes, n.split, at + 1) : place(nodes, n.split, at + 1);
            if (right_is_leaf) return place_leaf(nodes, n.split + 1, right);
            i = n.split + 1;
            at = right;
        }
    }

    std::span<const Bounds3> boxes_;
    std::span<const MortonKey> keys_;
    BuildOptions options_;
    RadixTree radix_;
    BigArray<Subtree> subtrees_; // of inner nodes
};

Tree build(const Primitives&, std::span<const Bounds3> boxes, const BuildOptions& options) {
    return build_lbvh(boxes, options);
}

} // namespace

Tree build_lbvh(std::span<const Bounds3> boxes, const BuildOptions& options, MortonBits bits) {
    MortonCoder coder(boxes, static_cast<int>(bits) / 3);
    if (coder.count() == 0) return {};
    BigArray<MortonKey> keys(coder.count());
    coder.write(keys.all());
    BigArray<MortonKey> scratch(keys.size());
    sort_by_code(keys.all(), scratch.all());
    return LbvhBuilder(boxes, keys.all(), options, std::move(scratch)).build();
}

AccelBuilder lbvh_builder() {
    return {"lbvh", "Morton codes, all nodes built at once (Karras 2012)", build};
}

} // namespace alhazen
