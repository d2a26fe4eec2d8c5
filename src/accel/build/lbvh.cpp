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
/// cost; see also radix_tree.h. So subtrees that are leaves in any case are found first (leaf_runs.h) and the
/// radix tree branches above them only, which makes no difference to the result. The order of nodes in
/// memory, left to chance there, is depth-first here: the sizes of the subtrees, counted on the way up, say
/// where each goes.
#include "accel/build/lbvh.h"

#include <cstring>

#include "accel/build/leaf_runs.h"
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

// What a node of the radix tree will be.
struct Subtree {
    float box[6];
    float cost;          // area times tests
    std::uint32_t nodes; // how many of the tree's nodes it takes

    Bounds3 bounds() const { return {{box[0], box[1], box[2]}, {box[3], box[4], box[5]}}; }
};

template <class T>
void resize(std::vector<T>& v, std::size_t size) {
    v.reserve(size);
    prefer_huge_pages(v.data(), size * sizeof(T));
    v.resize(size);
}

class LbvhBuilder {
  public:
    LbvhBuilder(std::span<const Bounds3> boxes, BigArray<MortonKey>&& keys, const BuildOptions& options)
        : options_(options), leaf_size_(std::min(options.leaf_size, Tree::max_leaf_size)),
          runs_(keys.all(), certain_leaf(options)), leaves_(runs_.count()) {
        resize(tree_.order, keys.size());
        BigArray<MortonKey> run_keys(runs_.count());
        parallel_ranges(runs_.count(), task_size, [&](std::size_t begin, std::size_t end) {
            for (std::size_t run = begin; run < end; ++run) {
                run_keys[run] = keys[runs_.first(run)];
                make_leaf(boxes, keys.all(), run);
            }
        });
        keys_ = std::move(run_keys);
    }

    Tree build() {
        const RadixTree radix(keys_.all());
        radix_ = &radix;
        subtrees_ = BigArray<Subtree>(radix.inner());
        radix.bottom_up([this](std::uint32_t i, RadixTree::Node n) { fit(i, n); });
        resize(tree_.nodes, radix.inner() ? subtrees_[0].nodes : 1);
        radix.inner() ? place(0, 0) : place_leaf(0, 0);
        return std::move(tree_);
    }

  private:
    // Up to so many primitives are better off in one leaf than in two, wherever they are.
    static std::uint32_t certain_leaf(const BuildOptions& options) {
        if (options.node_cost < 1) return 1;
        return std::max(1u, std::min({options.leaf_size, options.block, Tree::max_leaf_size}));
    }
    float tests(std::uint32_t primitives) const {
        const std::uint32_t blocks = (primitives + options_.block - 1) / options_.block;
        return static_cast<float>(blocks);
    }

    void make_leaf(std::span<const Bounds3> boxes, std::span<const MortonKey> keys, std::size_t run) {
        const std::uint32_t first = runs_.first(run), end = first + runs_.size(run);
        BoxLanes box(&boxes[keys[first].index].lo.x);
        for (std::uint32_t i = first; i < end; ++i) {
            if (i + fetch_ahead < keys.size()) __builtin_prefetch(&boxes[keys[i + fetch_ahead].index]);
            tree_.order[i] = keys[i].index;
            box.extend(BoxLanes(&boxes[keys[i].index].lo.x));
        }
        Subtree& leaf = leaves_[run];
        box.store(leaf.box);
        leaf.cost = box.half_area() * tests(end - first);
        leaf.nodes = 1;
    }

    const Subtree& child(std::uint32_t number, bool is_leaf) const {
        return is_leaf ? leaves_[number] : subtrees_[number];
    }
    // Primitives below a node of the radix tree.
    std::uint32_t count(RadixTree::Node n) const { return runs_.first(n.last + 1) - runs_.first(n.first); }

    void fit(std::uint32_t i, RadixTree::Node n) {
        const Subtree &l = child(n.split, n.split == n.first), &r = child(n.split + 1, n.split + 1 == n.last);
        BoxLanes box(l.box);
        box.extend(BoxLanes(r.box));
        const float area = box.half_area();
        const float split_cost = area * options_.node_cost + (l.cost + r.cost);
        const std::uint32_t primitives = count(n);
        const float leaf_cost = area * tests(primitives);
        const bool is_leaf = primitives <= leaf_size_ && leaf_cost <= split_cost;
        Subtree& s = subtrees_[i];
        box.store(s.box);
        s.cost = is_leaf ? leaf_cost : split_cost;
        s.nodes = is_leaf ? 1 : 1 + l.nodes + r.nodes;
    }

    void place_leaf(std::uint32_t run, std::uint32_t at) {
        tree_.nodes[at] = {leaves_[run].bounds(), runs_.first(run), runs_.size(run)};
    }
    // Writes the subtree of an inner node to the places from at on.
    void place(std::uint32_t i, std::uint32_t at) {
        for (;;) {
            const RadixTree::Node n = radix_->node(i);
            const Subtree& s = subtrees_[i];
            if (s.nodes == 1) {
                tree_.nodes[at] = {s.bounds(), runs_.first(n.first), count(n)};
                return;
            }
            const bool left_is_leaf = n.split == n.first, right_is_leaf = n.split + 1 == n.last;
            const std::uint32_t right = at + 1 + child(n.split, left_is_leaf).nodes;
            tree_.nodes[at] = {s.bounds(), right, 0};
            if (n.count() > task_size && !left_is_leaf && !right_is_leaf) {
                parallel_invoke([&] { place(n.split, at + 1); }, [&] { place(n.split + 1, right); });
                return;
            }
            left_is_leaf ? place_leaf(n.split, at + 1) : place(n.split, at + 1);
            if (right_is_leaf) return place_leaf(n.split + 1, right);
            i = n.split + 1;
            at = right;
        }
    }

    BuildOptions options_;
    std::uint32_t leaf_size_;
    LeafRuns runs_;
    BigArray<MortonKey> keys_;   // of the runs
    BigArray<Subtree> leaves_;   // the runs
    BigArray<Subtree> subtrees_; // inner nodes
    const RadixTree* radix_ = nullptr;
    Tree tree_;
};

// A layout that makes leaves of several primitives from those of one gets them at once, which is quicker.
Tree build(const Primitives&, std::span<const Bounds3> boxes, const BuildOptions& options) {
    BuildOptions quick = options;
    if (options.joined > 1) quick.leaf_size = quick.block = options.joined;
    return build_lbvh(boxes, quick);
}

} // namespace

Tree build_lbvh(std::span<const Bounds3> boxes, const BuildOptions& options, MortonBits bits) {
    MortonCoder coder(boxes, static_cast<int>(bits) / 3);
    if (coder.count() == 0) return {};
    BigArray<MortonKey> keys(coder.count());
    coder.write(keys.all());
    BigArray<MortonKey> scratch(keys.size());
    sort_by_code(keys.all(), scratch.all());
    scratch = {};
    return LbvhBuilder(boxes, std::move(keys), options).build();
}

AccelBuilder lbvh_builder() {
    return {"lbvh", "Morton codes, all nodes built at once (Karras 2012)", build};
}

} // namespace alhazen
