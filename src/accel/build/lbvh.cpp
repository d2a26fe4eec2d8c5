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

#include "accel/build/radix_tree.h"
#include "accel/list.h"
#include "base/lanes.h"

namespace alhazen {

namespace {

// Subtrees of so many primitives are worth a task of their own.
constexpr std::uint32_t task_size = 16384;
// How far ahead of use boxes are fetched: they are read in the curve's order, not in memory's.
constexpr std::size_t fetch_ahead = 16;

// What a subtree will be: its box, its cost (area times tests), and how many of the tree's nodes it takes.
// The last two live in the box's fourth lanes, so that all is two registers.
struct Subtree {
    Lanes4 lo, hi;

    float cost() const { return lo[3]; }
    std::uint32_t nodes() const { return std::bit_cast<std::uint32_t>(static_cast<float>(hi[3])); }
    void set(float cost, std::uint32_t nodes) {
        lo[3] = cost;
        hi[3] = std::bit_cast<float>(nodes);
    }
    Bounds3 bounds() const { return {to_vec3(lo), to_vec3(hi)}; }
};

float half_area(Lanes4 lo, Lanes4 hi) {
    Lanes4 d = hi - lo;
    return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
}

class LbvhBuilder {
  public:
    LbvhBuilder(std::span<const Bounds3> boxes, std::span<const MortonKey> keys, const BuildOptions& options)
        : boxes_(boxes), keys_(keys), node_cost_(options.node_cost),
          leaf_size_(std::min(options.leaf_size, Tree::max_leaf_size)), radix_(keys),
          subtrees_(radix_.inner()) {}

    Tree build() {
        Tree tree;
        radix_.bottom_up([this](std::size_t leaf) { fetch(leaf + fetch_ahead); },
                         [this](std::uint32_t node) { fit(node); });
        reserve(tree.order, keys_.size());
        tree.order.resize(keys_.size());
        parallel_ranges(keys_.size(), task_size, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) tree.order[i] = keys_[i].index;
        });
        const std::size_t nodes = radix_.inner() ? subtrees_[0].nodes() : 1;
        reserve(tree.nodes, nodes);
        tree.nodes.resize(nodes);
        if (radix_.inner())
            place(tree.nodes.data(), 0, 0);
        else
            tree.nodes[0] = leaf_node(0);
        return tree;
    }

  private:
    template <class T>
    static void reserve(std::vector<T>& v, std::size_t size) {
        v.reserve(size);
        prefer_large_pages(v.data(), size * sizeof(T));
    }
    void fetch(std::size_t leaf) const {
        if (leaf < keys_.size()) __builtin_prefetch(&boxes_[keys_[leaf].index]);
    }

    Subtree child(std::uint32_t number, bool is_leaf) const {
        if (!is_leaf) return subtrees_[number];
        const Bounds3& box = boxes_[keys_[number].index];
        Subtree s{to_lanes(box.lo), to_lanes(box.hi)};
        s.set(half_area(s.lo, s.hi), 1);
        return s;
    }

    void fit(std::uint32_t i) {
        const RadixTree::Node n = radix_.node(i);
        const Subtree left = child(n.split, n.split == n.first);
        const Subtree right = child(n.split + 1, n.split + 1 == n.last);
        Subtree s{min_lanes(left.lo, right.lo), max_lanes(left.hi, right.hi)};
        const float area = half_area(s.lo, s.hi);
        const float split_cost = area * node_cost_ + (left.cost() + right.cost());
        const float leaf_cost = area * static_cast<float>(n.count());
        const bool is_leaf = n.count() <= leaf_size_ && leaf_cost <= split_cost;
        s.set(is_leaf ? leaf_cost : split_cost, is_leaf ? 1 : 1 + left.nodes() + right.nodes());
        subtrees_[i] = s;
    }

    Tree::Node leaf_node(std::uint32_t leaf) const { return {boxes_[keys_[leaf].index], leaf, 1}; }

    // Writes the subtree of inner node i to the places from at on.
    void place(Tree::Node* nodes, std::uint32_t i, std::uint32_t at) const {
        const RadixTree::Node n = radix_.node(i);
        const Subtree& s = subtrees_[i];
        if (s.nodes() == 1) {
            nodes[at] = {s.bounds(), n.first, n.count()};
            return;
        }
        const bool left_is_leaf = n.split == n.first, right_is_leaf = n.split + 1 == n.last;
        const std::uint32_t right = at + 1 + (left_is_leaf ? 1 : subtrees_[n.split].nodes());
        nodes[at] = {s.bounds(), right, 0};
        auto place_left = [&] {
            if (left_is_leaf)
                nodes[at + 1] = leaf_node(n.split);
            else
                place(nodes, n.split, at + 1);
        };
        auto place_right = [&] {
            if (right_is_leaf)
                nodes[right] = leaf_node(n.split + 1);
            else
                place(nodes, n.split + 1, right);
        };
        if (n.count() > task_size) {
            parallel_invoke(place_left, place_right);
        } else {
            place_left();
            place_right();
        }
    }

    std::span<const Bounds3> boxes_;
    std::span<const MortonKey> keys_;
    float node_cost_;
    std::uint32_t leaf_size_;
    RadixTree radix_;
    RawBuffer<Subtree> subtrees_; // of inner nodes
};

Tree build(const Primitives&, std::span<const Bounds3> boxes, const BuildOptions& options) {
    return build_lbvh(boxes, options);
}

} // namespace

Tree build_lbvh(std::span<const Bounds3> boxes, const BuildOptions& options, MortonBits bits) {
    MortonCoder coder(boxes, static_cast<int>(bits) / 3);
    if (coder.count() == 0) return {};
    RawBuffer<MortonKey> keys(coder.count());
    coder.write(keys);
    {
        RawBuffer<MortonKey> scratch(keys.size());
        sort_by_code(keys, scratch);
    }
    return LbvhBuilder(boxes, keys, options).build();
}

AccelBuilder lbvh_builder() {
    return {"lbvh", "Morton codes, all nodes built at once (Karras 2012)", build};
}

} // namespace alhazen
