#include "accel/layout/collapse.h"

#include <algorithm>
#include <cstring>

#include "base/big_array.h"
#include "base/lanes.h"
#include "base/threads.h"

namespace alhazen {

namespace {

constexpr int most_places = CollapsedNode::most_children;

constexpr std::size_t at(int places) {
    return static_cast<std::size_t>(places - 1);
}

// Which kinds of primitives there are, as far as that matters.
struct Kinds {
    bool triangles = false, customs = false;

    bool mixed() const { return triangles && customs; }
    Kinds operator|(Kinds k) const { return {triangles || k.triangles, customs || k.customs}; }
};

// The kinds of a tree's primitives.
class KindsOf {
  public:
    // All primitives count as triangles.
    explicit KindsOf(const Tree& tree) : tree_(tree), all_{true, false} {}
    KindsOf(const Tree& tree, const Primitives& primitives) : tree_(tree), primitives_(&primitives) {
        const PrimitiveKinds kinds = primitives.kinds();
        all_ = {kinds.triangle || kinds.filtered_triangle, kinds.custom};
    }

    bool mixed() const { return all_.mixed(); }
    // Of a run of the order. Usually there is one kind in all, and nobody has to look.
    Kinds operator()(std::uint32_t first, std::uint32_t count) const {
        if (!all_.mixed()) return all_;
        Kinds kinds;
        for (std::uint32_t k = 0; k < count; ++k) kinds = kinds | of(tree_.order[first + k]);
        return kinds;
    }

  private:
    Kinds of(std::uint32_t primitive) const {
        const bool custom = primitives_->kind(primitive) == PrimitiveKind::custom;
        return {!custom, custom};
    }

    const Tree& tree_;
    const Primitives* primitives_ = nullptr;
    Kinds all_;
};

// Binary trees whose leaves fit: those with too many primitives, or with more than one kind, are halved until
// they do, with the same box.
class LeafCutter {
  public:
    LeafCutter(const Tree& tree, const KindsOf& kinds, std::uint32_t leaf_size)
        : tree_(tree), kinds_(kinds), leaf_size_(leaf_size) {}

    bool has_work() const {
        if (leaf_size_ >= Tree::max_leaf_size && !kinds_.mixed()) return false;
        return std::any_of(tree_.nodes.begin(), tree_.nodes.end(),
                           [&](const Tree::Node& n) { return n.is_leaf() && !fits(n); });
    }

    std::vector<Tree::Node> cut() {
        std::vector<std::uint32_t> place(tree_.nodes.size());
        std::vector<std::size_t> inner; // copies whose right child is still numbered as in the tree
        for (std::size_t i = 0; i < tree_.nodes.size(); ++i) {
            place[i] = static_cast<std::uint32_t>(nodes_.size());
            if (tree_.nodes[i].is_leaf()) {
                add(tree_.nodes[i]);
            } else {
                inner.push_back(nodes_.size());
                nodes_.push_back(tree_.nodes[i]);
            }
        }
        for (std::size_t i : inner) nodes_[i].first_or_right = place[nodes_[i].first_or_right];
        return std::move(nodes_);
    }

  private:
    bool fits(const Tree::Node& leaf) const {
        return leaf.count <= leaf_size_ && !kinds_(leaf.first_or_right, leaf.count).mixed();
    }
    void add(const Tree::Node& leaf) {
        nodes_.push_back(leaf);
        if (fits(leaf)) return;
        const std::size_t parent = nodes_.size() - 1;
        const std::uint32_t half = leaf.count / 2;
        add({leaf.bounds, leaf.first_or_right, half});
        nodes_[parent].first_or_right = static_cast<std::uint32_t>(nodes_.size());
        nodes_[parent].count = 0;
        add({leaf.bounds, leaf.first_or_right + half, leaf.count - half});
    }

    const Tree& tree_;
    const KindsOf& kinds_;
    std::uint32_t leaf_size_;
    std::vector<Tree::Node> nodes_;
};

// What was decided for a binary node, in one word, since there are many.
class Choice {
  public:
    // Of 2 ... 8 places, how many the left child gets.
    int left(int places) const { return static_cast<int>(bits_ >> (3 * (places - 2)) & 7); }
    // Whether to take so many costs less than to take fewer.
    bool pays(int places) const { return bits_ >> (19 + places) & 1; }
    // Whether a single place is for a leaf.
    bool is_leaf() const { return bits_ >> 28; }

    void set_left(int places, int left) { bits_ |= static_cast<std::uint32_t>(left) << (3 * (places - 2)); }
    void set_pays(int places, bool pays) { bits_ |= static_cast<std::uint32_t>(pays) << (19 + places); }
    void set_leaf() { bits_ |= 1u << 28; }

  private:
    std::uint32_t bits_ = 0;
};

// The costs from which a node's parent decides.
struct Forests {
    std::array<float, most_places> cost; // when at most so many places are taken
    int useful;                          // as many places as there are leaves; more change nothing
    std::uint32_t count;                 // primitives
    Kinds kinds;
};

// The best of all ways to share out places among two children, for every number of places at once.
struct Shares {
    alignas(16) std::array<float, most_places> cost;
    alignas(16) std::array<int, most_places> left;

    Shares(const Forests& l, const Forests& r) {
        // The right child's costs, behind those of places it does not have.
        float right[2 * most_places];
        std::fill_n(right, most_places, infinity);
        std::memcpy(right + most_places, r.cost.data(), sizeof r.cost);
        Lanes4 best[2] = {all_lanes(infinity), all_lanes(infinity)};
        IntLanes4 choice[2] = {IntLanes4{1, 1, 1, 1}, IntLanes4{1, 1, 1, 1}};
        const int most = std::min(l.useful, most_places - 1);
        for (int k = 1; k <= most; ++k)
            for (int half = 0; half < 2; ++half) {
                Lanes4 rest;
                std::memcpy(&rest, right + most_places - k + 4 * half, sizeof rest);
                const Lanes4 sum = rest + l.cost[at(k)];
                const IntLanes4 better = sum < best[half];
                best[half] = better ? sum : best[half];
                choice[half] = better ? IntLanes4{k, k, k, k} : choice[half];
            }
        std::memcpy(cost.data(), best, sizeof cost);
        std::memcpy(left.data(), choice, sizeof left);
    }
};

// Decides from the leaves up.
class Decisions {
  public:
    Decisions(std::span<const Tree::Node> nodes, const KindsOf& kinds, const CollapseCosts& costs,
              const WideShape& shape)
        : nodes_(nodes), kinds_(kinds), costs_(costs), shape_(shape), choices_(nodes.size()) {
        const Forests root = decide(0, nodes.size());
        cost_ = static_cast<double>(root.cost[0]) / static_cast<double>(nodes[0].bounds.half_area());
    }

    const Choice& operator[](std::size_t node) const { return choices_[node]; }
    double cost() const { return cost_; }

  private:
    // Subtrees in parallel, then what is above them. A subtree's nodes stand one after another.
    Forests decide(std::size_t node, std::size_t end) {
        if (nodes_[node].is_leaf() || end - node <= std::max<std::size_t>(4096, nodes_.size() / 64))
            return decide_one_by_one(node, end);
        const std::size_t right = nodes_[node].first_or_right;
        Forests l, r;
        parallel_invoke([&] { l = decide(node + 1, right); }, [&] { r = decide(right, end); });
        return join(node, l, r);
    }
    Forests decide_one_by_one(std::size_t first, std::size_t end) {
        // From the last node to the first, a node's left child comes just before it, and its right child
        // before that one's subtree: children are what was pushed last.
        std::vector<Forests> stack;
        stack.reserve(CollapsedTree::max_depth + 1);
        for (std::size_t i = end; i-- > first;) {
            if (nodes_[i].is_leaf()) {
                stack.push_back(leaf(i));
            } else {
                const Forests left = stack.back();
                stack.pop_back();
                stack.back() = join(i, left, stack.back());
            }
        }
        return stack.back();
    }

    Forests leaf(std::size_t i) {
        const Tree::Node& n = nodes_[i];
        Forests f{{}, 1, n.count, kinds_(n.first_or_right, n.count)};
        f.cost.fill(leaf_cost(f, n.bounds.half_area()));
        choices_[i] = {};
        choices_[i].set_leaf();
        return f;
    }
    Forests join(std::size_t i, const Forests& l, const Forests& r) {
        const float area = nodes_[i].bounds.half_area();
        Forests f{{}, std::min(l.useful + r.useful, most_places), l.count + r.count, l.kinds | r.kinds};
        const Shares shares(l, r);
        Choice choice;
        for (int places = 2; places <= most_places; ++places)
            choice.set_left(places, shares.left[at(places)]);
        f.cost[0] = shares.cost[at(shape_.width)] + area * costs_.node;
        if (f.count <= shape_.leaf_size && !f.kinds.mixed() && leaf_cost(f, area) <= f.cost[0]) {
            f.cost[0] = leaf_cost(f, area);
            choice.set_leaf();
        }
        for (int places = 2; places <= most_places; ++places) {
            const float shared = shares.cost[at(places)], fewer = f.cost[at(places - 1)];
            choice.set_pays(places, shared < fewer);
            f.cost[at(places)] = std::min(shared, fewer);
        }
        choices_[i] = choice;
        return f;
    }
    float leaf_cost(const Forests& f, float area) const {
        const auto count = static_cast<float>(f.count);
        return area * (f.kinds.customs ? count * costs_.custom : costs_.leaf + count * costs_.triangle);
    }

    std::span<const Tree::Node> nodes_;
    const KindsOf& kinds_;
    const CollapseCosts& costs_;
    const WideShape& shape_;
    BigArray<Choice> choices_;
    double cost_ = 0;
};

// Writes down what was decided.
class Expansion {
  public:
    Expansion(std::span<const Tree::Node> nodes, const KindsOf& kinds, const Decisions& decisions,
              const WideShape& shape)
        : nodes_(nodes), kinds_(kinds), decisions_(decisions), shape_(shape) {}

    CollapsedTree run() const {
        CollapsedTree tree;
        tree.cost = decisions_.cost();
        if (decisions_[0].is_leaf() && shape_.has_lone_leaf) {
            tree.single_leaf = leaf_of(0);
            tree.stack = 1;
            return tree;
        }
        expand(tree);
        return tree;
    }
    // No path is longer than a third of the binary one, for nodes of eight.
    CollapsedTree by_height() {
        heights_.resize(nodes_.size());
        for (std::size_t i = nodes_.size(); i-- > 0;)
            if (!nodes_[i].is_leaf())
                heights_[i] = static_cast<std::uint8_t>(
                    1 + std::max(heights_[i + 1], heights_[nodes_[i].first_or_right]));
        return run();
    }

  private:
    // A binary subtree, whose nodes stand one after another.
    struct Subtree {
        std::uint32_t root, end;
    };
    using Subtrees = std::vector<Subtree>;
    // A wide node to be filled from a subtree.
    struct Open {
        std::uint32_t wide;
        Subtree from;
        int depth; // of its children
    };

    // Nodes that stand one after another, and what a walk of them needs.
    struct Part {
        std::vector<CollapsedNode> nodes;
        int depth = 0;
        std::uint32_t stack = 0;
    };

    void expand(CollapsedTree& tree) const {
        const auto size = static_cast<std::uint32_t>(nodes_.size());
        // What is above large subtrees first, then these, each by itself and in parallel.
        const std::uint32_t piece = std::max(16384u, size / 64);
        Part top;
        std::vector<Open> later;
        expand(top, {0, {0, size}, 1}, piece, later);
        std::vector<Part> parts(later.size());
        parallel_for(later.size(), 1, [&](std::size_t i) {
            std::vector<Open> none;
            expand(parts[i], {0, later[i].from, later[i].depth}, 0, none);
            std::vector<std::uint32_t> need(parts[i].nodes.size(), 0);
            parts[i].stack = stack_of(parts[i].nodes, need);
        });
        join(top, later, parts, tree);
    }
    // Each part's root goes to the place kept for it, its other nodes behind those there are.
    static void join(const Part& top, const std::vector<Open>& later, std::vector<Part>& parts,
                     CollapsedTree& tree) {
        std::vector<std::uint32_t> behind(parts.size()), need(top.nodes.size(), 0);
        auto total = static_cast<std::uint32_t>(top.nodes.size());
        tree.depth = top.depth;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            behind[i] = total;
            total += static_cast<std::uint32_t>(parts[i].nodes.size()) - 1;
            tree.depth = std::max(tree.depth, parts[i].depth);
            need[later[i].wide] = parts[i].stack;
        }
        tree.stack = stack_of(top.nodes, need) + 1;
        tree.nodes = BigArray<CollapsedNode>(total);
        std::copy(top.nodes.begin(), top.nodes.end(), tree.nodes.data());
        parallel_for(parts.size(), 1, [&](std::size_t i) {
            std::vector<CollapsedNode> part = std::move(parts[i].nodes);
            for (CollapsedNode& node : part)
                for (std::size_t k = 0; k < node.children().size(); ++k)
                    if (!node.child[k].is_leaf()) node.child[k].node += behind[i] - 1;
            tree.nodes[later[i].wide] = part[0];
            std::copy(part.begin() + 1, part.end(), tree.nodes.data() + behind[i]);
        });
    }

    // Subtrees of no more than piece nodes are left for later.
    void expand(Part& part, const Open& root, std::uint32_t piece, std::vector<Open>& later) const {
        std::vector<Open> open{root};
        Subtrees children;
        // About right where leaves are full already; too much elsewhere, which is not touched.
        part.nodes.reserve((root.from.end - root.from.root) / 12 + 1);
        part.nodes.emplace_back();
        while (!open.empty()) {
            const Open o = open.back();
            open.pop_back();
            if (o.from.end - o.from.root <= piece) {
                later.push_back(o);
                continue;
            }
            children.clear();
            choose_children(o.from, children);
            if (shape_.by_size) sort_by_size(children);
            fill(part, o, children, open);
        }
    }
    void fill(Part& part, const Open& o, const Subtrees& children, std::vector<Open>& open) const {
        part.depth = std::max(part.depth, o.depth);
        // Room for the children that are nodes; then nothing moves any more.
        auto next = static_cast<std::uint32_t>(part.nodes.size());
        std::size_t inner = 0;
        for (const Subtree& child : children) inner += !decisions_[child.root].is_leaf();
        part.nodes.resize(part.nodes.size() + inner);
        CollapsedNode& node = part.nodes[o.wide];
        node.count = static_cast<int>(children.size());
        const std::size_t first = open.size();
        for (std::size_t k = 0; k < children.size(); ++k) {
            WideChild& child = node.child[k];
            child.bounds = nodes_[children[k].root].bounds;
            if (decisions_[children[k].root].is_leaf()) {
                child.leaf = leaf_of(children[k].root);
            } else {
                child.node = next++;
                open.push_back({child.node, children[k], o.depth + 1});
            }
        }
        // The first child is to be the next.
        std::reverse(open.begin() + static_cast<std::ptrdiff_t>(first), open.end());
    }
    void choose_children(const Subtree& s, Subtrees& children) const {
        if (decisions_[s.root].is_leaf()) {
            children.push_back(s); // only above a single leaf
        } else if (!heights_.empty()) {
            choose_by_height(s, children);
        } else {
            share_out(s, shape_.width, children);
        }
    }
    void distribute(const Subtree& s, int places, Subtrees& children) const {
        while (places > 1 && !decisions_[s.root].pays(places)) --places;
        if (places == 1)
            children.push_back(s);
        else
            share_out(s, places, children);
    }
    void share_out(const Subtree& s, int places, Subtrees& children) const {
        const int left = decisions_[s.root].left(places);
        distribute(left_of(s), left, children);
        distribute(right_of(s), places - left, children);
    }
    // The highest subtree is opened as long as there are places.
    void choose_by_height(const Subtree& s, Subtrees& children) const {
        children = {left_of(s), right_of(s)};
        while (children.size() < static_cast<std::size_t>(shape_.width)) {
            auto highest =
                std::max_element(children.begin(), children.end(), [&](const Subtree& a, const Subtree& b) {
                    return heights_[a.root] < heights_[b.root];
                });
            const Subtree opened = *highest;
            if (nodes_[opened.root].is_leaf()) return;
            *highest = left_of(opened);
            children.insert(highest + 1, right_of(opened));
        }
    }
    Subtree left_of(const Subtree& s) const { return {s.root + 1, nodes_[s.root].first_or_right}; }
    Subtree right_of(const Subtree& s) const { return {nodes_[s.root].first_or_right, s.end}; }
    // By insertion, as they are few; equal ones stay as they are.
    void sort_by_size(Subtrees& children) const {
        auto area = [&](const Subtree& s) { return nodes_[s.root].bounds.half_area(); };
        for (std::size_t i = 1; i < children.size(); ++i)
            for (std::size_t k = i; k > 0 && area(children[k]) < area(children[k - 1]); --k)
                std::swap(children[k], children[k - 1]);
    }

    WideLeaf leaf_of(std::uint32_t i) const {
        WideLeaf leaf;
        add_to_leaf(i, leaf);
        leaf.is_custom = kinds_(leaf.first, 1).customs;
        return leaf;
    }
    void add_to_leaf(std::uint32_t i, WideLeaf& leaf) const {
        if (nodes_[i].is_leaf()) {
            if (leaf.count == 0) leaf.first = nodes_[i].first_or_right;
            leaf.count += nodes_[i].count;
        } else {
            add_to_leaf(i + 1, leaf);
            add_to_leaf(nodes_[i].first_or_right, leaf);
        }
    }

    // Entries that a walk from the first node needs. need: of each node, 0 where it has to be found yet.
    static std::uint32_t stack_of(std::span<const CollapsedNode> nodes, std::vector<std::uint32_t>& need) {
        for (std::size_t i = nodes.size(); i-- > 0;) {
            if (need[i]) continue;
            std::uint32_t deepest = 1;
            for (const WideChild& child : nodes[i].children())
                if (!child.is_leaf()) deepest = std::max(deepest, need[child.node]);
            need[i] = static_cast<std::uint32_t>(nodes[i].count) - 1 + deepest;
        }
        return need[0];
    }

    std::span<const Tree::Node> nodes_;
    const KindsOf& kinds_;
    const Decisions& decisions_;
    const WideShape& shape_;
    std::vector<std::uint8_t> heights_; // when collapsed by height
};

CollapsedTree collapse(const Tree& tree, const KindsOf& kinds, const CollapseCosts& costs,
                       const WideShape& shape) {
    if (tree.nodes.empty()) return {};
    std::vector<Tree::Node> cut;
    if (LeafCutter cutter(tree, kinds, shape.leaf_size); cutter.has_work()) cut = cutter.cut();
    const std::span<const Tree::Node> nodes = cut.empty() ? tree.nodes : cut;
    const Decisions decisions(nodes, kinds, costs, shape);
    Expansion expansion(nodes, kinds, decisions, shape);
    CollapsedTree collapsed = expansion.run();
    return collapsed.stack <= shape.stack ? std::move(collapsed) : expansion.by_height();
}

} // namespace

CollapsedTree collapse(const Tree& tree, const CollapseCosts& costs, const WideShape& shape) {
    return collapse(tree, KindsOf(tree), costs, shape);
}

CollapsedTree collapse(const Tree& tree, const Primitives& primitives, const CollapseCosts& costs,
                       std::uint32_t stack_limit) {
    return collapse(tree, KindsOf(tree, primitives), costs,
                    {.stack = stack_limit, .has_lone_leaf = true, .by_size = true});
}

} // namespace alhazen
