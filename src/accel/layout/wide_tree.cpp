#include "accel/layout/wide_tree.h"

#include <array>

namespace alhazen {

namespace {

using Nodes = std::vector<Tree::Node>;

// The leaf's range as a subtree of leaves of at most max_leaf primitives.
void add_leaves(Nodes& nodes, const Tree::Node& leaf, std::uint32_t max_leaf) {
    nodes.push_back(leaf);
    if (leaf.count <= max_leaf) return;
    const std::size_t parent = nodes.size() - 1;
    const std::uint32_t half = leaf.count / 2;
    add_leaves(nodes, {leaf.bounds, leaf.first_or_right, half}, max_leaf);
    nodes[parent].first_or_right = static_cast<std::uint32_t>(nodes.size());
    nodes[parent].count = 0;
    add_leaves(nodes, {leaf.bounds, leaf.first_or_right + half, leaf.count - half}, max_leaf);
}

Nodes with_small_leaves(const Tree& tree, std::uint32_t max_leaf) {
    Nodes nodes;
    std::vector<std::uint32_t> place(tree.nodes.size());
    std::vector<std::size_t> inner; // copies whose right child is still numbered as in the tree
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        place[i] = static_cast<std::uint32_t>(nodes.size());
        if (tree.nodes[i].is_leaf()) {
            add_leaves(nodes, tree.nodes[i], max_leaf);
        } else {
            inner.push_back(nodes.size());
            nodes.push_back(tree.nodes[i]);
        }
    }
    for (std::size_t i : inner) nodes[i].first_or_right = place[nodes[i].first_or_right];
    return nodes;
}

class Collapse {
  public:
    Collapse(std::span<const Tree::Node> nodes, int width, std::uint32_t max_leaf, const CollapseCost& cost)
        : nodes_(nodes), width_(width), max_leaf_(max_leaf), cost_(cost), choices_(nodes.size()) {}

    WideTree run() {
        choose();
        WideTree wide;
        wide.nodes.emplace_back();
        std::vector<Pending> stack{{0, 0, 1}};
        while (!stack.empty()) {
            Pending pending = stack.back();
            stack.pop_back();
            emit(wide, pending, stack);
        }
        return wide;
    }

  private:
    // What a binary node has decided: at [i - 1] for a forest of i trees, how many of them the left child
    // becomes; 0 where i - 1 trees are as good. [0]: 1 where a single tree is a leaf.
    using Choice = std::array<std::uint8_t, WideTree::max_width>;

    // The costs from which the parent decides.
    struct Forests {
        std::array<float, WideTree::max_width> cost; // [i - 1]: of a forest of at most i trees
        std::uint32_t first, count;                  // the primitives
        bool is_run;                                 // they stand one after another
    };

    void choose() {
        // In this order a node's left child comes just before it, and its right child before that one's
        // subtree: children are what was pushed last.
        std::vector<Forests> stack;
        for (std::size_t i = nodes_.size(); i-- > 0;) {
            const Tree::Node& n = nodes_[i];
            if (n.is_leaf()) {
                Forests f{{}, n.first_or_right, n.count, true};
                f.cost.fill(leaf_cost(n.bounds, n.count));
                choices_[i][0] = 1;
                stack.push_back(f);
            } else {
                Forests left = stack.back();
                stack.pop_back();
                stack.back() = choose(n.bounds, left, stack.back(), choices_[i]);
            }
        }
    }

    Forests choose(const Bounds3& bounds, const Forests& left, const Forests& right, Choice& choice) const {
        Forests f{{}, left.first, left.count + right.count, false};
        f.is_run = left.is_run && right.is_run && left.first + left.count == right.first;
        for (int i = 2; i <= width_; ++i) {
            float best = left.cost[0] + right.cost[at(i - 1)];
            choice[at(i)] = 1;
            for (int k = 2; k < i; ++k) {
                float cost = left.cost[at(k)] + right.cost[at(i - k)];
                if (cost < best) {
                    best = cost;
                    choice[at(i)] = static_cast<std::uint8_t>(k);
                }
            }
            f.cost[at(i)] = best;
        }
        const float node = f.cost[at(width_)] + bounds.half_area() * cost_.node;
        f.cost[0] = node;
        if (f.is_run && f.count <= max_leaf_ && leaf_cost(bounds, f.count) <= node) {
            f.cost[0] = leaf_cost(bounds, f.count);
            choice[0] = 1;
        }
        // A forest of many may be dearer than one of few: then the few.
        for (int i = 2; i < width_; ++i)
            if (!(f.cost[at(i)] < f.cost[at(i - 1)])) {
                f.cost[at(i)] = f.cost[at(i - 1)];
                choice[at(i)] = 0;
            }
        return f;
    }

    float leaf_cost(const Bounds3& bounds, std::uint32_t count) const {
        return bounds.half_area() * static_cast<float>(count) * cost_.primitive;
    }
    static constexpr std::size_t at(int trees) { return static_cast<std::size_t>(trees - 1); }

    struct Pending {
        std::uint32_t wide, binary; // the wide node that is to be filled from the binary one
        int depth;                  // of its children
    };

    void emit(WideTree& wide, const Pending& pending, std::vector<Pending>& stack) const {
        std::vector<std::uint32_t> roots;
        if (choices_[pending.binary][0])
            roots.push_back(pending.binary); // only above a single leaf
        else
            gather_below(pending.binary, width_, roots);
        WideTree::Node& node = wide.nodes[pending.wide];
        node = {static_cast<std::uint32_t>(wide.children.size()), static_cast<std::uint32_t>(roots.size())};
        wide.depth = std::max(wide.depth, pending.depth);
        const std::size_t first = stack.size();
        for (std::uint32_t root : roots) {
            const bool is_leaf = choices_[root][0] != 0;
            WideTree::Child child{nodes_[root].bounds, 0, 0};
            if (is_leaf) {
                set_range(root, child);
            } else {
                child.index = static_cast<std::uint32_t>(wide.nodes.size());
                wide.nodes.emplace_back();
                stack.push_back({child.index, root, pending.depth + 1});
            }
            wide.children.push_back(child);
        }
        // The first child is to be the next.
        std::reverse(stack.begin() + static_cast<std::ptrdiff_t>(first), stack.end());
    }

    // The roots of the best forest of at most so many trees.
    void gather(std::uint32_t i, int trees, std::vector<std::uint32_t>& roots) const {
        while (trees > 1 && choices_[i][at(trees)] == 0) --trees;
        if (trees == 1)
            roots.push_back(i);
        else
            gather_below(i, trees, roots);
    }
    void gather_below(std::uint32_t i, int trees, std::vector<std::uint32_t>& roots) const {
        const int left = choices_[i][at(trees)];
        gather(i + 1, left, roots);
        gather(nodes_[i].first_or_right, trees - left, roots);
    }

    void set_range(std::uint32_t i, WideTree::Child& leaf) const {
        if (nodes_[i].is_leaf()) {
            if (leaf.count == 0) leaf.index = nodes_[i].first_or_right;
            leaf.count += nodes_[i].count;
        } else {
            set_range(i + 1, leaf);
            set_range(nodes_[i].first_or_right, leaf);
        }
    }

    std::span<const Tree::Node> nodes_;
    int width_;
    std::uint32_t max_leaf_;
    CollapseCost cost_;
    std::vector<Choice> choices_;
};

} // namespace

WideTree collapse(const Tree& tree, int width, std::uint32_t max_leaf, const CollapseCost& cost) {
    if (tree.nodes.empty()) return {};
    for (const Tree::Node& n : tree.nodes)
        if (n.count > max_leaf) {
            Nodes nodes = with_small_leaves(tree, max_leaf);
            return Collapse(nodes, width, max_leaf, cost).run();
        }
    return Collapse(tree.nodes, width, max_leaf, cost).run();
}

} // namespace alhazen
