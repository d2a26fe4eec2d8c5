/// Writes a tree's nodes in depth-first order, for builders that go through some other structure and know
/// each node's box only after its children's.
#pragma once

#include "accel/build/tree.h"

namespace alhazen {

class TreeWriter {
  public:
    /// What a subtree became.
    struct Written {
        Bounds3 bounds;
        float cost = 0; ///< area times tests, as the surface area heuristic counts
    };
    /// Appends to tree's nodes; its order is the caller's.
    TreeWriter(Tree& tree, const BuildOptions& options) : tree_(tree), options_(options) {}

    std::uint32_t leaf_size() const { return std::min(options_.leaf_size, Tree::max_leaf_size); }
    /// What a leaf of the size would cost.
    float leaf_cost(const Bounds3& bounds, std::uint32_t count) const {
        const std::uint32_t blocks = (count + options_.block - 1) / options_.block;
        return bounds.half_area() * static_cast<float>(blocks);
    }

    /// A leaf over count (1 ... Tree::max_leaf_size) places of the order.
    Written leaf(const Bounds3& bounds, std::uint32_t first, std::uint32_t count) {
        tree_.nodes.push_back({bounds, first, count});
        return {bounds, leaf_cost(bounds, count)};
    }
    /// An inner node: left() and right() write its children.
    template <class Left, class Right>
    Written inner(const Left& left, const Right& right) {
        const std::size_t at = tree_.nodes.size();
        tree_.nodes.emplace_back();
        const Written l = left();
        tree_.nodes[at].first_or_right = static_cast<std::uint32_t>(tree_.nodes.size());
        const Written r = right();
        Written w = l;
        w.bounds.extend(r.bounds);
        w.cost = w.bounds.half_area() * options_.node_cost + (l.cost + r.cost);
        tree_.nodes[at].bounds = w.bounds;
        return w;
    }
    /// Makes one leaf of all nodes from at on, the subtree written last, if it is cheaper: it covers count
    /// places of the order from first on.
    Written collapse(std::size_t at, const Written& written, std::uint32_t first, std::uint32_t count) {
        if (count > leaf_size() || !(leaf_cost(written.bounds, count) <= written.cost)) return written;
        tree_.nodes.resize(at);
        return leaf(written.bounds, first, count);
    }
    /// Leaves over the places first ... end - 1 of the order, halved until they are small enough; bounds_of
    /// gives the box of a place. For what nothing better tells apart.
    template <class BoundsOf>
    Written halves(std::uint32_t first, std::uint32_t end, const BoundsOf& bounds_of) {
        const std::uint32_t count = end - first, middle = first + count / 2;
        if (count > leaf_size())
            return inner([&] { return halves(first, middle, bounds_of); },
                         [&] { return halves(middle, end, bounds_of); });
        Bounds3 bounds;
        for (std::uint32_t place = first; place < end; ++place) bounds.extend(bounds_of(place));
        return leaf(bounds, first, count);
    }
    std::size_t next() const { return tree_.nodes.size(); }

  private:
    Tree& tree_;
    BuildOptions options_;
};

} // namespace alhazen
