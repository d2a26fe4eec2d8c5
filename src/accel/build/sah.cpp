/// Builds trees by the surface area heuristic over bins.
///
/// Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies": the centroids of a node's
/// primitives are counted into a few bins along each axis; of the planes between bins the one is taken that
/// makes (area of the left box x primitives in it) + (the same on the right) least, since a random ray that
/// meets the node meets a child with probability proportional to the child's area.
#include "accel/list.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "base/lanes.h"
#include "base/threads.h"

namespace alhazen {

namespace {

constexpr int bin_count = 16;
// Below this depth splits follow the heuristic; from it on they halve, so that the depth stays bounded.
constexpr int halving_depth = Tree::max_depth - 32;
// Ranges this large are worth a task of their own, and a parallel loop.
constexpr std::size_t task_size = 4096;
constexpr std::size_t loop_grain = 16384;

// A primitive while the tree is built; its number hides in lo's fourth lane, so that a box and its number
// move as two registers.
struct Reference {
    Lanes4 lo, hi;

    std::uint32_t primitive() const { return std::bit_cast<std::uint32_t>(static_cast<float>(lo[3])); }
    Lanes4 centroid() const { return lo * 0.5f + hi * 0.5f; }
};

struct LaneBox {
    Lanes4 lo = all_lanes(infinity), hi = all_lanes(-infinity);

    void extend(Lanes4 l, Lanes4 h) {
        lo = min_lanes(l, lo);
        hi = max_lanes(h, hi);
    }
    float half_area() const {
        Lanes4 d = hi - lo;
        return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
    }
    Bounds3 bounds() const { return {to_vec3(lo), to_vec3(hi)}; }
};

// The boxes around a range's primitives and around their centroids.
struct Extent {
    LaneBox boxes, centroids;

    void add(const Reference& r) {
        boxes.extend(r.lo, r.hi);
        Lanes4 c = r.centroid();
        centroids.extend(c, c);
    }
    void join(const Extent& other) {
        boxes.extend(other.boxes.lo, other.boxes.hi);
        centroids.extend(other.centroids.lo, other.centroids.hi);
    }
};

// Which bin a centroid falls into, on the three axes at once.
struct Binning {
    Lanes4 origin, scale;

    explicit Binning(const LaneBox& centroids) : origin(centroids.lo), scale(all_lanes(0)) {
        Lanes4 extent = centroids.hi - centroids.lo;
        for (int axis = 0; axis < 3; ++axis) {
            // 0.999: the largest centroid falls into the last bin, not behind it.
            float s = 0.999f * bin_count / extent[axis];
            if (std::isfinite(extent[axis]) && std::isfinite(s) && extent[axis] > 0) scale[axis] = s;
        }
    }
    bool splits(int axis) const { return scale[axis] > 0; }
    int bin(Lanes4 centroid, int axis) const {
        return std::min(static_cast<int>((centroid[axis] - origin[axis]) * scale[axis]), bin_count - 1);
    }
};

struct Bins {
    std::array<std::array<LaneBox, bin_count>, 3> box;
    std::array<std::array<std::uint32_t, bin_count>, 3> count{};

    void add(const Reference& r, const Binning& binning) {
        Lanes4 place = (r.centroid() - binning.origin) * binning.scale;
        for (int axis = 0; axis < 3; ++axis) {
            if (!binning.splits(axis)) continue;
            auto a = static_cast<std::size_t>(axis);
            auto b = static_cast<std::size_t>(std::min(static_cast<int>(place[axis]), bin_count - 1));
            box[a][b].extend(r.lo, r.hi);
            ++count[a][b];
        }
    }
    void join(const Bins& other) {
        for (std::size_t a = 0; a < 3; ++a)
            for (std::size_t b = 0; b < bin_count; ++b) {
                box[a][b].extend(other.box[a][b].lo, other.box[a][b].hi);
                count[a][b] += other.count[a][b];
            }
    }
};

// Sums over references: at once for few, in parallel for many, always over the same pieces in the same order.
template <class Sum, class Add>
Sum sum_over(std::span<const Reference> references, const Add& add) {
    Sum whole;
    if (references.size() <= loop_grain) {
        for (const Reference& r : references) add(whole, r);
        return whole;
    }
    return parallel_sum(
        references.size(), loop_grain, whole,
        [&](Sum& sum, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) add(sum, references[i]);
        },
        [](Sum& sum, const Sum& part) { sum.join(part); });
}

struct Split {
    int axis = -1; // -1: none
    int bin = 0;   // the first bin of the right side
    float cost = infinity;
};

Split best_split_of_axis(const Bins& bins, int axis) {
    const auto& box = bins.box[static_cast<std::size_t>(axis)];
    const auto& count = bins.count[static_cast<std::size_t>(axis)];
    std::array<float, bin_count> right_cost{};
    LaneBox side;
    std::uint32_t n = 0;
    for (std::size_t b = bin_count; b-- > 1;) {
        side.extend(box[b].lo, box[b].hi);
        n += count[b];
        right_cost[b] = n ? side.half_area() * static_cast<float>(n) : infinity;
    }
    Split best;
    side = {};
    n = 0;
    for (std::size_t b = 1; b < bin_count; ++b) {
        side.extend(box[b - 1].lo, box[b - 1].hi);
        n += count[b - 1];
        float cost = n ? side.half_area() * static_cast<float>(n) + right_cost[b] : infinity;
        if (cost < best.cost) best = {axis, static_cast<int>(b), cost};
    }
    return best;
}

class SahBuilder {
  public:
    SahBuilder(std::span<const Bounds3> boxes, const BuildOptions& options) : options_(options) {
        references_.reserve(boxes.size());
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const Bounds3& b = boxes[i];
            if (b.empty()) continue;
            float number = std::bit_cast<float>(static_cast<std::uint32_t>(i));
            references_.push_back({to_lanes(b.lo, number), to_lanes(b.hi)});
        }
    }

    Tree build() {
        Tree tree;
        if (references_.empty()) return tree;
        // A subtree of n primitives is given 2 n - 1 places whether it needs them or not: so where a node
        // stands does not depend on who is ready first.
        nodes_.resize(2 * references_.size() - 1);
        build_node(0, 0, references_.size(), 0);
        pack(tree);
        tree.order.reserve(references_.size());
        for (const Reference& r : references_) tree.order.push_back(r.primitive());
        return tree;
    }

  private:
    void build_node(std::size_t node, std::size_t begin, std::size_t end, int depth) {
        std::span<Reference> range(references_.data() + begin, end - begin);
        auto extent = sum_over<Extent>(range, [](Extent& e, const Reference& r) { e.add(r); });
        Tree::Node& n = nodes_[node];
        n.bounds = extent.boxes.bounds();
        std::size_t left = range.size() == 1 ? 0 : split(range, extent, depth);
        if (left == 0) {
            n.first_or_right = static_cast<std::uint32_t>(begin);
            n.count = static_cast<std::uint32_t>(range.size());
            return;
        }
        std::size_t middle = begin + left, right = node + 2 * left;
        n.first_or_right = static_cast<std::uint32_t>(right);
        auto build_left = [&] { build_node(node + 1, begin, middle, depth + 1); };
        auto build_right = [&] { build_node(right, middle, end, depth + 1); };
        if (range.size() > task_size) {
            parallel_invoke(build_left, build_right);
        } else {
            build_left();
            build_right();
        }
    }

    // Puts the left child's references first and returns how many they are; 0 for a leaf.
    std::size_t split(std::span<Reference> range, const Extent& extent, int depth) const {
        bool may_be_leaf = range.size() <= std::min(options_.leaf_size, Tree::max_leaf_size);
        Binning binning(extent.centroids);
        Split best;
        if (depth < halving_depth) best = find_split(range, binning);
        if (best.axis < 0) return may_be_leaf ? 0 : halve(range, extent);
        float area = extent.boxes.half_area();
        if (may_be_leaf && area * static_cast<float>(range.size()) <= area * options_.node_cost + best.cost)
            return 0;
        auto middle = std::partition(range.begin(), range.end(), [&](const Reference& r) {
            return binning.bin(r.centroid(), best.axis) < best.bin;
        });
        return static_cast<std::size_t>(middle - range.begin());
    }

    static Split find_split(std::span<const Reference> range, const Binning& binning) {
        auto bins = sum_over<Bins>(range, [&](Bins& b, const Reference& r) { b.add(r, binning); });
        Split best;
        for (int axis = 0; axis < 3; ++axis) {
            if (!binning.splits(axis)) continue;
            Split s = best_split_of_axis(bins, axis);
            if (s.cost < best.cost) best = s;
        }
        return best;
    }

    // Where bins do not help (coincident centroids, overflowing areas, too deep already): half of the
    // primitives to each side, along the longest axis of the centroids.
    static std::size_t halve(std::span<Reference> range, const Extent& extent) {
        Lanes4 size = extent.centroids.hi - extent.centroids.lo;
        int axis = max_dimension(to_vec3(size));
        auto middle = range.begin() + static_cast<std::ptrdiff_t>(range.size() / 2);
        std::nth_element(range.begin(), middle, range.end(), [axis](const Reference& a, const Reference& b) {
            float ca = a.centroid()[axis], cb = b.centroid()[axis];
            return ca != cb ? ca < cb : a.primitive() < b.primitive();
        });
        return range.size() / 2;
    }

    // Takes the unused places out; the nodes stay in depth-first order.
    void pack(Tree& tree) const {
        std::vector<std::uint32_t> place(nodes_.size());
        std::uint32_t used = 0;
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            place[i] = used;
            used += is_used(nodes_[i]);
        }
        tree.nodes.reserve(used);
        for (const Tree::Node& n : nodes_) {
            if (!is_used(n)) continue;
            tree.nodes.push_back(n);
            if (!n.is_leaf()) tree.nodes.back().first_or_right = place[n.first_or_right];
        }
    }
    static bool is_used(const Tree::Node& n) { return n.count > 0 || n.first_or_right > 0; }

    BuildOptions options_;
    std::vector<Reference> references_;
    std::vector<Tree::Node> nodes_;
};

Tree build(const Primitives&, std::span<const Bounds3> boxes, const BuildOptions& options) {
    return SahBuilder(boxes, options).build();
}

} // namespace

AccelBuilder sah_builder() {
    return {"sah", "surface area heuristic over bins (Wald 2007)", build};
}

} // namespace alhazen
