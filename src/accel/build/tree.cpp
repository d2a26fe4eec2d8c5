#include "accel/build/tree.h"

#include "base/hash.h"
#include "base/threads.h"

namespace alhazen {

namespace {

// Calls visit(node, depth) for every node, parents first.
template <class Visit>
void for_each_node(const Tree& tree, const Visit& visit) {
    if (tree.nodes.empty()) return;
    std::vector<std::pair<std::size_t, int>> stack{{0, 0}};
    while (!stack.empty()) {
        auto [i, depth] = stack.back();
        stack.pop_back();
        visit(i, depth);
        if (tree.nodes[i].is_leaf()) continue;
        stack.push_back({tree.nodes[i].first_or_right, depth + 1});
        stack.push_back({i + 1, depth + 1});
    }
}

// Points uniform over the surface of a primitive, which is a box unless it is a triangle.
class SurfaceSampler {
  public:
    explicit SurfaceSampler(const Primitives& primitives) : primitives_(primitives) {
        areas_.reserve(primitives.count());
        for (std::uint32_t i = 0; i < primitives.count(); ++i) {
            total_ += area(i);
            areas_.push_back(total_);
        }
    }
    double total() const { return total_; }

    struct Point {
        Vec3 p;
        std::uint32_t primitive;
    };
    Point sample(Rng& rng) const {
        auto chosen =
            std::upper_bound(areas_.begin(), areas_.end(), static_cast<double>(rng.uniform()) * total_);
        auto i = static_cast<std::uint32_t>(std::min<std::ptrdiff_t>(
            chosen - areas_.begin(), static_cast<std::ptrdiff_t>(areas_.size()) - 1));
        if (primitives_.kind(i) == PrimitiveKind::custom) return {on_box(primitives_.bounds(i), rng), i};
        Corners t = primitives_.corners(i);
        float u = rng.uniform(), v = rng.uniform();
        if (u + v > 1) u = 1 - u, v = 1 - v;
        return {t.a + (t.b - t.a) * u + (t.c - t.a) * v, i};
    }

  private:
    double area(std::uint32_t i) const {
        double area = 0;
        if (primitives_.kind(i) == PrimitiveKind::custom) {
            area = 2 * static_cast<double>(primitives_.bounds(i).half_area());
        } else {
            Corners t = primitives_.corners(i);
            Vec3d a(t.a);
            area = 0.5 * length(cross(Vec3d(t.b) - a, Vec3d(t.c) - a));
        }
        return std::isfinite(area) ? area : 0;
    }
    static Vec3 on_box(const Bounds3& box, Rng& rng) {
        Vec3 d = box.diagonal();
        float choice = rng.uniform() * box.half_area();
        int axis = choice < d.y * d.z ? 0 : choice < d.y * d.z + d.z * d.x ? 1 : 2;
        Vec3 p = box.lo + Vec3{rng.uniform(), rng.uniform(), rng.uniform()} * d;
        p[axis] = rng.below(2) ? box.lo[axis] : box.hi[axis];
        return p;
    }

    const Primitives& primitives_;
    std::vector<double> areas_; // running sums
    double total_ = 0;
};

} // namespace

TreeStats stats_of(const Tree& tree, float node_cost, std::uint32_t block) {
    TreeStats stats;
    stats.nodes = tree.nodes.size();
    stats.references = tree.order.size();
    double cost = 0;
    for_each_node(tree, [&](std::size_t i, int depth) {
        const Tree::Node& n = tree.nodes[i];
        stats.depth = std::max(stats.depth, depth);
        stats.leaves += n.is_leaf();
        double area = static_cast<double>(n.bounds.half_area());
        std::uint32_t tests = (n.count + block - 1) / block;
        cost += area * (n.is_leaf() ? static_cast<double>(tests) : static_cast<double>(node_cost));
    });
    if (!tree.nodes.empty()) {
        double root = static_cast<double>(tree.nodes[0].bounds.half_area());
        stats.sah_cost = root > 0 ? cost / root : 0;
    }
    return stats;
}

double end_point_overlap(const Tree& tree, const Primitives& primitives, std::size_t samples) {
    SurfaceSampler surface(primitives);
    if (tree.nodes.empty() || !(surface.total() > 0)) return 0;
    // Where each primitive's leaves are: a node owns a run of the order.
    std::vector<std::vector<std::uint32_t>> places(primitives.count());
    for (std::uint32_t k = 0; k < tree.order.size(); ++k) places[tree.order[k]].push_back(k);
    std::vector<std::uint32_t> first(tree.nodes.size()), end(tree.nodes.size());
    for (std::size_t i = tree.nodes.size(); i-- > 0;) {
        const Tree::Node& n = tree.nodes[i];
        first[i] = n.is_leaf() ? n.first_or_right : first[i + 1];
        end[i] = n.is_leaf() ? n.first_or_right + n.count : end[n.first_or_right];
    }
    Rng rng(1);
    double sum = 0;
    std::vector<std::size_t> stack;
    for (std::size_t s = 0; s < samples; ++s) {
        auto point = surface.sample(rng);
        stack.assign(1, 0);
        while (!stack.empty()) {
            std::size_t i = stack.back();
            stack.pop_back();
            const Tree::Node& n = tree.nodes[i];
            if (!n.bounds.contains(point.p)) continue;
            bool is_own = false;
            for (std::uint32_t place : places[point.primitive]) is_own |= place >= first[i] && place < end[i];
            if (!is_own) sum += n.is_leaf() ? n.count : 1;
            if (n.is_leaf()) continue;
            stack.push_back(i + 1);
            stack.push_back(n.first_or_right);
        }
    }
    return sum / static_cast<double>(samples);
}

namespace {

class Refit {
  public:
    Refit(Tree& tree, std::span<const Bounds3> boxes) : tree_(tree), boxes_(boxes) {}

    // Whether every primitive that can be hit has a place, and there is one.
    bool is_enough() {
        std::vector<std::uint8_t> has_place(boxes_.size(), 0);
        std::size_t present = 0;
        for (std::uint32_t primitive : tree_.order) {
            has_place[primitive] = 1;
            present += !boxes_[primitive].empty();
        }
        some_are_empty_ = present < tree_.order.size();
        for (std::size_t i = 0; i < boxes_.size(); ++i)
            if (!has_place[i] && !boxes_[i].empty()) return false;
        return present > 0;
    }
    void run() {
        fit(0, tree_.nodes.size());
        if (!some_are_empty_) return;
        // What holds nothing any more becomes a point of the node above.
        for (std::size_t i = 0; i < tree_.nodes.size(); ++i) {
            const Tree::Node& n = tree_.nodes[i];
            if (n.is_leaf()) continue;
            for (std::size_t child : {i + 1, std::size_t{n.first_or_right}})
                if (Bounds3& box = tree_.nodes[child].bounds; box.empty()) box = {n.bounds.lo, n.bounds.lo};
        }
    }

  private:
    static constexpr std::size_t task_size = 16384;

    // A subtree, whose nodes stand one after another, in parallel where it is large.
    void fit(std::size_t node, std::size_t end) {
        if (end - node > task_size && !tree_.nodes[node].is_leaf()) {
            const std::size_t right = tree_.nodes[node].first_or_right;
            parallel_invoke([&] { fit(node + 1, right); }, [&] { fit(right, end); });
            fit(node);
        } else {
            // Children stand behind their parents.
            for (std::size_t i = end; i-- > node;) fit(i);
        }
    }
    void fit(std::size_t node) {
        Tree::Node& n = tree_.nodes[node];
        n.bounds = {};
        if (n.is_leaf()) {
            for (std::uint32_t k = 0; k < n.count; ++k)
                n.bounds.extend(boxes_[tree_.order[n.first_or_right + k]]);
        } else {
            n.bounds.extend(tree_.nodes[node + 1].bounds);
            n.bounds.extend(tree_.nodes[n.first_or_right].bounds);
        }
    }

    Tree& tree_;
    std::span<const Bounds3> boxes_;
    bool some_are_empty_ = false;
};

} // namespace

bool refit(Tree& tree, std::span<const Bounds3> boxes) {
    Refit refit(tree, boxes);
    if (!refit.is_enough()) return false;
    refit.run();
    return true;
}

} // namespace alhazen
