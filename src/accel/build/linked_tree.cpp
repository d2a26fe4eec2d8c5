#include "accel/build/linked_tree.h"

#include <algorithm>

#include "base/threads.h"

namespace alhazen {

namespace {

// Subtrees above this depth are tasks of their own.
constexpr int task_depth = 8;

class Finisher {
  public:
    Finisher(LinkedTree& linked, const BuildOptions& options)
        : linked_(linked), node_cost_(options.node_cost),
          leaf_size_(std::min(options.leaf_size, Tree::max_leaf_size)), block_(options.block),
          below_(linked.nodes.size()) {}

    Tree run() {
        measure(linked_.root, 0);
        std::size_t nodes = below_[linked_.root].nodes;
        tree_.nodes.reserve(nodes);
        prefer_huge_pages(tree_.nodes.data(), nodes * sizeof(Tree::Node));
        tree_.nodes.resize(nodes);
        tree_.order.resize(below_[linked_.root].references);
        place(linked_.root, 0, 0, 0);
        return std::move(tree_);
    }

  private:
    // What a node and all below it come to.
    struct Below {
        std::uint32_t nodes;      // in the finished tree; 1: a leaf
        std::uint32_t references; // places in the order
        float cost;               // times the root's area
    };

    float tests(std::uint32_t primitives) const {
        const std::uint32_t blocks = (primitives + block_ - 1) / block_;
        return static_cast<float>(blocks);
    }

    void measure(std::uint32_t i, int depth) {
        LinkedTree::Node& n = linked_.nodes[i];
        if (n.is_leaf()) {
            below_[i] = {1, n.count, n.bounds().half_area() * tests(n.count)};
            return;
        }
        if (depth < task_depth) {
            parallel_invoke([&] { measure(n.left, depth + 1); }, [&] { measure(n.right, depth + 1); });
        } else {
            measure(n.left, depth + 1);
            measure(n.right, depth + 1);
        }
        Bounds3 bounds = linked_.nodes[n.left].bounds();
        bounds.extend(linked_.nodes[n.right].bounds());
        n.set_bounds(bounds);
        const Below &left = below_[n.left], &right = below_[n.right];
        float area = bounds.half_area();
        std::uint32_t references = left.references + right.references;
        float as_node = area * node_cost_ + left.cost + right.cost;
        float as_leaf = area * tests(references);
        if (references <= leaf_size_ && as_leaf <= as_node)
            below_[i] = {1, references, as_leaf};
        else
            below_[i] = {1 + left.nodes + right.nodes, references, as_node};
    }

    // Writes a node to its place in the finished tree, its primitives from first on, and all below it.
    void place(std::uint32_t i, std::uint32_t node, std::uint32_t first, int depth) {
        const LinkedTree::Node& n = linked_.nodes[i];
        Tree::Node& placed = tree_.nodes[node];
        placed.bounds = n.bounds();
        if (below_[i].nodes == 1) {
            placed.first_or_right = first;
            placed.count = below_[i].references;
            gather(i, first);
            return;
        }
        std::uint32_t right = node + 1 + below_[n.left].nodes;
        std::uint32_t right_first = first + below_[n.left].references;
        placed.first_or_right = right;
        if (depth < task_depth) {
            parallel_invoke([&] { place(n.left, node + 1, first, depth + 1); },
                            [&] { place(n.right, right, right_first, depth + 1); });
        } else {
            place(n.left, node + 1, first, depth + 1);
            place(n.right, right, right_first, depth + 1);
        }
    }

    void gather(std::uint32_t i, std::uint32_t first) {
        const LinkedTree::Node& n = linked_.nodes[i];
        if (!n.is_leaf()) {
            gather(n.left, first);
            gather(n.right, first + below_[n.left].references);
            return;
        }
        for (std::uint32_t k = 0; k < n.count; ++k) tree_.order[first + k] = linked_.order[n.left + k];
    }

    LinkedTree& linked_;
    float node_cost_;
    std::uint32_t leaf_size_, block_;
    BigArray<Below> below_;
    Tree tree_;
};

} // namespace

LinkedTree linked(Tree&& tree) {
    LinkedTree linked;
    linked.nodes = BigArray<LinkedTree::Node>(tree.nodes.size());
    parallel_ranges(tree.nodes.size(), 16384, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Tree::Node& n = tree.nodes[i];
            if (n.is_leaf())
                linked.nodes[i].make_leaf(n.bounds, n.first_or_right, n.count);
            else
                linked.nodes[i].make_inner(static_cast<std::uint32_t>(i) + 1, n.first_or_right);
        }
    });
    linked.order = std::move(tree.order);
    return linked;
}

Tree finish(LinkedTree&& linked, const BuildOptions& options) {
    if (linked.nodes.size() == 0) return {};
    return Finisher(linked, options).run();
}

void collapse_leaves(Tree& tree, const BuildOptions& options) {
    tree = finish(linked(std::move(tree)), options);
}

} // namespace alhazen
