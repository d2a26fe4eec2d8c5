#include "accel/wide/collapse.h"

#include "base/threads.h"

namespace alhazen {

namespace {

constexpr std::size_t width = 8;
constexpr std::uint32_t leaf_capacity = 8;

// What is known of a subtree.
struct Summary {
    // Least cost when the subtree may take up to i + 1 places.
    std::array<float, width> cost;
    // When exactly so many places are taken (two or more): how many of them the left child gets.
    std::array<std::uint8_t, width> left{};
    std::uint8_t pays = 0;              // bit i: taking i + 1 places costs less than taking fewer
    std::uint32_t first = 0, count = 0; // of the order
    std::uint8_t height = 0;
    bool has_triangles = false, has_custom = false;
    bool is_leaf = false; // as one place: a leaf, not a node

    bool is_mixed() const { return has_triangles && has_custom; }
};

class Collapser {
  public:
    Collapser(const Tree& tree, const Primitives& primitives, const CollapseCosts& costs)
        : tree_(tree), primitives_(primitives), costs_(costs), summaries_(tree.nodes.size()) {}

    CollapsedTree run(std::uint32_t stack_limit) {
        CollapsedTree result;
        if (tree_.nodes.empty()) return result;
        summarize();
        const Summary& root = summaries_[0];
        if (root.is_leaf && !root.is_mixed()) {
            result.single_leaf = leaf_of(0, root.has_custom);
            result.stack = 1;
            return result;
        }
        expand(result);
        if (result.stack > stack_limit) {
            by_height_ = true;
            expand(result);
        }
        result.cost =
            static_cast<double>(root.cost[0]) / static_cast<double>(tree_.nodes[0].bounds.half_area());
        return result;
    }

  private:
    // A node's subtree, or the primitives of one kind in a mixed leaf.
    struct Part {
        enum Which : std::uint8_t { all, triangles, custom };
        std::uint32_t node;
        Which which = all;
    };

    // Subtrees in parallel, then what is above them. Children stand behind their parents.
    void summarize() {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> subtrees; // root, end
        std::vector<std::uint32_t> above;
        std::vector<std::pair<std::uint32_t, std::uint32_t>> stack{
            {0, static_cast<std::uint32_t>(tree_.nodes.size())}};
        const std::size_t piece = std::max<std::size_t>(4096, tree_.nodes.size() / 64);
        while (!stack.empty()) {
            auto [node, end] = stack.back();
            stack.pop_back();
            if (end - node <= piece || tree_.nodes[node].is_leaf()) {
                subtrees.push_back({node, end});
                continue;
            }
            above.push_back(node);
            const std::uint32_t right = tree_.nodes[node].first_or_right;
            stack.push_back({node + 1, right});
            stack.push_back({right, end});
        }
        parallel_for(subtrees.size(), 1, [&](std::size_t s) {
            for (std::uint32_t i = subtrees[s].second; i-- > subtrees[s].first;) summarize_node(i);
        });
        std::sort(above.begin(), above.end());
        for (std::size_t i = above.size(); i-- > 0;) summarize_node(above[i]);
    }

    void summarize_node(std::uint32_t i) {
        const Tree::Node& node = tree_.nodes[i];
        Summary& s = summaries_[i];
        const float area = node.bounds.half_area();
        if (node.is_leaf()) {
            s.first = node.first_or_right;
            s.count = node.count;
            for (std::uint32_t k = 0; k < node.count; ++k) {
                bool custom = primitives_.kind(tree_.order[s.first + k]) == PrimitiveKind::custom;
                (custom ? s.has_custom : s.has_triangles) = true;
            }
            s.is_leaf = true;
            s.cost.fill(leaf_cost(s, area));
            return;
        }
        const Summary &l = summaries_[i + 1], &r = summaries_[node.first_or_right];
        s.first = l.first;
        s.count = l.count + r.count;
        s.height = static_cast<std::uint8_t>(std::max(l.height, r.height) + 1);
        s.has_triangles = l.has_triangles || r.has_triangles;
        s.has_custom = l.has_custom || r.has_custom;
        std::array<float, width> shared;
        for (std::size_t places = 2; places <= width; ++places) {
            float best = infinity;
            for (std::size_t k = 1; k < places; ++k) {
                float cost = l.cost[k - 1] + r.cost[places - k - 1];
                if (cost < best) best = cost, s.left[places - 1] = static_cast<std::uint8_t>(k);
            }
            shared[places - 1] = best;
        }
        s.cost[0] = shared[width - 1] + area * costs_.node;
        if (s.count <= leaf_capacity && !s.is_mixed()) {
            float cost = leaf_cost(s, area);
            s.is_leaf = cost <= s.cost[0];
            s.cost[0] = std::min(cost, s.cost[0]);
        }
        for (std::size_t k = 1; k < width; ++k) {
            s.pays |= static_cast<std::uint8_t>((shared[k] < s.cost[k - 1]) << k);
            s.cost[k] = std::min(shared[k], s.cost[k - 1]);
        }
    }

    float leaf_cost(const Summary& s, float area) const {
        float custom = s.has_custom ? static_cast<float>(s.count) * costs_.custom : 0;
        return area * (custom + (s.has_triangles ? costs_.leaf : 0));
    }

    WideLeaf leaf_of(std::uint32_t node, bool is_custom) const {
        return {summaries_[node].first, summaries_[node].count, is_custom};
    }

    // The places a subtree takes when it may use up to so many.
    void distribute(std::uint32_t i, std::size_t places, std::vector<Part>& parts) const {
        const Tree::Node& node = tree_.nodes[i];
        const Summary& s = summaries_[i];
        while (places > 1 && !(s.pays >> (places - 1) & 1)) --places;
        if (places == 1) {
            parts.push_back({i});
            return;
        }
        const std::size_t left = s.left[places - 1];
        distribute(i + 1, left, parts);
        distribute(node.first_or_right, places - left, parts);
    }

    void children_by_cost(std::uint32_t i, std::vector<Part>& parts) const {
        const std::size_t left = summaries_[i].left[width - 1];
        distribute(i + 1, left, parts);
        distribute(tree_.nodes[i].first_or_right, width - left, parts);
    }

    // The highest subtree is opened as long as there are places: no path is longer than a third of the binary
    // one.
    void children_by_height(std::uint32_t i, std::vector<Part>& parts) const {
        parts.push_back({i + 1});
        parts.push_back({tree_.nodes[i].first_or_right});
        while (parts.size() < width) {
            auto highest = std::max_element(parts.begin(), parts.end(), [&](const Part& a, const Part& b) {
                return summaries_[a.node].height < summaries_[b.node].height;
            });
            const std::uint32_t node = highest->node;
            if (tree_.nodes[node].is_leaf()) return;
            highest->node = node + 1;
            parts.push_back({tree_.nodes[node].first_or_right});
        }
    }

    void children(Part part, std::vector<Part>& parts) const {
        parts.clear();
        if (tree_.nodes[part.node].is_leaf()) {
            parts.push_back({part.node, Part::triangles});
            parts.push_back({part.node, Part::custom});
        } else if (by_height_) {
            children_by_height(part.node, parts);
        } else {
            children_by_cost(part.node, parts);
        }
        // The largest is visited first by rays that look for any hit.
        std::stable_sort(parts.begin(), parts.end(), [&](const Part& a, const Part& b) {
            return tree_.nodes[a.node].bounds.half_area() < tree_.nodes[b.node].bounds.half_area();
        });
    }

    bool becomes_leaf(Part part) const {
        const Summary& s = summaries_[part.node];
        if (part.which != Part::all) return true;
        return s.is_leaf && !s.is_mixed();
    }

    void expand(CollapsedTree& result) const {
        result.nodes.clear();
        result.depth = 0;
        struct Open {
            std::uint32_t number;
            Part part;
            int depth;
        };
        std::vector<Open> open{{0, {0}, 0}};
        std::vector<Part> parts;
        result.nodes.emplace_back();
        while (!open.empty()) {
            const Open o = open.back();
            open.pop_back();
            children(o.part, parts);
            result.depth = std::max(result.depth, o.depth + 1);
            result.nodes[o.number].count = static_cast<int>(parts.size());
            for (std::size_t k = 0; k < parts.size(); ++k) {
                WideChild child;
                child.bounds = tree_.nodes[parts[k].node].bounds;
                if (becomes_leaf(parts[k])) {
                    const Summary& s = summaries_[parts[k].node];
                    bool custom =
                        parts[k].which == Part::custom || (parts[k].which == Part::all && s.has_custom);
                    child.leaf = leaf_of(parts[k].node, custom);
                } else {
                    child.node = static_cast<std::uint32_t>(result.nodes.size());
                    result.nodes.emplace_back();
                    open.push_back({child.node, parts[k], o.depth + 1});
                }
                result.nodes[o.number].child[k] = child;
            }
        }
        result.stack = stack_of(result);
    }

    static std::uint32_t stack_of(const CollapsedTree& tree) {
        std::vector<std::uint32_t> need(tree.nodes.size(), 0);
        for (std::size_t i = tree.nodes.size(); i-- > 0;) {
            const CollapsedNode& node = tree.nodes[i];
            std::uint32_t deepest = 1;
            for (int k = 0; k < node.count; ++k)
                if (!node.child[static_cast<std::size_t>(k)].is_leaf())
                    deepest = std::max(deepest, need[node.child[static_cast<std::size_t>(k)].node]);
            need[i] = static_cast<std::uint32_t>(node.count) - 1 + deepest;
        }
        return need[0] + 1;
    }

    const Tree& tree_;
    const Primitives& primitives_;
    CollapseCosts costs_;
    std::vector<Summary> summaries_; // one a node of the tree
    bool by_height_ = false;
};

} // namespace

CollapsedTree collapse(const Tree& tree, const Primitives& primitives, const CollapseCosts& costs,
                       std::uint32_t stack_limit) {
    return Collapser(tree, primitives, costs).run(stack_limit);
}

} // namespace alhazen
