/// Builds octrees, all cells at once.
///
/// Karras 2012, "Maximizing Parallelism in the Construction of BVHs, Octrees, and k-d Trees", section 4.
/// Three bits of Morton code say in which octant of a cell a point is. So an octree's cells are the prefixes
/// of the codes whose length is a multiple of three, and all of them lie on the edges of the codes' radix
/// tree: an edge that leads from a prefix of 4 bits to one of 10 passes the cells of 6 and 9. Each edge
/// counts its cells, a prefix sum gives them places, and each finds the cell above it a step or two up the
/// radix tree. The paper divides every cell down to the last bit; here cells with few primitives may stay
/// whole, which an edge also sees by itself: the primitives of a cell are those of the radix node at the
/// edge's lower end.
///
/// It was made for GPUs, for points and with a thread for each edge. On a CPU the passes are loops over runs
/// of edges; what is lost is that two cores do not hide the steps up the tree. For ray tracing the cells are
/// given the boxes of their primitives, because an octree of cells alone would let rays miss what reaches
/// over a cell's side.
#include "accel/build/octree.h"

#include <utility>

#include "accel/build/radix_tree.h"
#include "accel/build/tree_writer.h"
#include "accel/list.h"

namespace alhazen {

namespace {

constexpr std::size_t grain = 8192;

class OctreeBuilder {
  public:
    OctreeBuilder(std::span<const Bounds3> boxes, std::span<const MortonKey> keys,
                  const OctreeOptions& options)
        : boxes_(boxes), keys_(keys), options_(options), radix_(keys), bounds_(radix_.inner()),
          first_cell_(radix_.inner() + radix_.leaves() + 1) {}

    Octree build() {
        radix_.bottom_up([this](std::uint32_t i, RadixTree::Node n) { fit(i, n); });
        number_cells();
        Octree octree;
        octree.max_level = options_.max_level;
        octree.nodes.resize(first_cell_.back());
        octree.order.resize(keys_.size());
        octree.codes.resize(keys_.size());
        parallel_for(keys_.size(), grain, [&](std::size_t i) {
            octree.order[i] = keys_[i].index;
            octree.codes[i] = keys_[i].code;
        });
        link_cells(octree);
        return octree;
    }

  private:
    // An edge is named by the radix node at its lower end: inner nodes first, then leaves. The root's edge
    // comes from nowhere.
    struct Range {
        std::uint32_t first, last;
        std::uint32_t count() const { return last - first + 1; }
    };
    bool is_inner(std::size_t edge) const { return edge < radix_.inner(); }
    Range range(std::size_t edge) const {
        if (is_inner(edge)) return {radix_.node(edge).first, radix_.node(edge).last};
        auto leaf = static_cast<std::uint32_t>(edge - radix_.inner());
        return {leaf, leaf};
    }
    std::uint32_t above(std::size_t edge) const {
        return is_inner(edge) ? radix_.parent_of_inner(edge) : radix_.parent_of_leaf(edge - radix_.inner());
    }
    // The level of the last cell that contains all of the node's primitives; -1 above the root.
    int level(std::size_t edge) const {
        if (!is_inner(edge)) return options_.max_level;
        // Codes have 3 max_level bits at the lower end of 64.
        int bits = radix_.common_bits(edge) - (64 - 3 * options_.max_level);
        return std::min(bits / 3, options_.max_level);
    }
    int level_above(std::size_t edge) const {
        std::uint32_t node = above(edge);
        return node == RadixTree::none ? -1 : level(node);
    }
    // The edge whose last cell is the one above an edge's first; none for the root's.
    std::uint32_t edge_of_parent(std::size_t edge) const {
        std::uint32_t node = above(edge);
        if (node == RadixTree::none) return node;
        while (level_above(node) == level(node)) node = above(node);
        return node;
    }

    std::uint32_t count_cells(std::size_t edge) const {
        const int passed = level(edge) - level_above(edge);
        if (passed == 0) return 0;
        const std::uint32_t parent = edge_of_parent(edge);
        if (parent != RadixTree::none && range(parent).count() <= options_.leaf_size) return 0;
        return range(edge).count() > options_.leaf_size ? static_cast<std::uint32_t>(passed) : 1;
    }

    void number_cells() {
        const std::size_t edges = radix_.inner() + radix_.leaves();
        parallel_for(edges, grain, [&](std::size_t edge) { first_cell_[edge] = count_cells(edge); });
        first_cell_[edges] = 0;
        std::uint32_t sum = 0;
        for (std::uint32_t& cells : first_cell_) sum += std::exchange(cells, sum);
    }
    std::uint32_t cells(std::size_t edge) const { return first_cell_[edge + 1] - first_cell_[edge]; }

    std::uint64_t prefix(std::size_t edge, int level) const {
        return keys_[range(edge).first].code >> 3 * (options_.max_level - level);
    }
    // The number, along the edges, of the cell above an edge's cell.
    std::uint32_t parent_cell(std::size_t edge, std::uint32_t cell) const {
        if (cell > first_cell_[edge]) return cell - 1;
        return first_cell_[edge_of_parent(edge) + 1] - 1;
    }
    template <class Visit>
    void for_each_cell(const Visit& visit) const {
        parallel_for(radix_.inner() + radix_.leaves(), grain, [&](std::size_t edge) {
            const int top = level_above(edge) + 1;
            for (std::uint32_t k = 0; k < cells(edge); ++k)
                visit(edge, first_cell_[edge] + k, top + static_cast<int>(k));
        });
    }

    // Cells are numbered along the edges; but in the octree those of one parent stand side by side.
    void link_cells(Octree& octree) const {
        std::vector<std::atomic<std::uint8_t>> masks(first_cell_.back());
        for_each_cell([&](std::size_t edge, std::uint32_t cell, int level) {
            if (level > 0)
                masks[parent_cell(edge, cell)].fetch_or(
                    static_cast<std::uint8_t>(1 << (prefix(edge, level) & 7)), std::memory_order_relaxed);
        });
        std::vector<std::uint32_t> first_child(masks.size());
        std::uint32_t place = 1; // behind the root
        for (std::size_t cell = 0; cell < masks.size(); ++cell) {
            first_child[cell] = place;
            place += static_cast<std::uint32_t>(std::popcount(masks[cell].load(std::memory_order_relaxed)));
        }
        for_each_cell([&](std::size_t edge, std::uint32_t cell, int level) {
            Octree::Node node;
            node.prefix = prefix(edge, level);
            node.begin = range(edge).first;
            node.end = range(edge).last + 1;
            node.bounds = bounds(edge);
            node.level = static_cast<std::uint8_t>(level);
            node.child_mask = masks[cell].load(std::memory_order_relaxed);
            node.first_child = node.child_mask ? first_child[cell] : 0;
            std::uint32_t own = 0;
            if (level > 0) {
                Octree::Node parent;
                const std::uint32_t up = parent_cell(edge, cell);
                parent.first_child = first_child[up];
                parent.child_mask = masks[up].load(std::memory_order_relaxed);
                own = parent.child(static_cast<int>(node.prefix & 7));
            }
            octree.nodes[own] = node;
        });
    }

    const Bounds3& bounds(std::size_t edge) const {
        return is_inner(edge) ? bounds_[edge] : boxes_[keys_[edge - radix_.inner()].index];
    }
    void fit(std::uint32_t i, RadixTree::Node n) {
        Bounds3 box = bounds(n.split == n.first ? radix_.inner() + n.split : n.split);
        box.extend(bounds(n.split + 1 == n.last ? radix_.inner() + n.last : n.split + 1));
        bounds_[i] = box;
    }

    std::span<const Bounds3> boxes_;
    std::span<const MortonKey> keys_;
    OctreeOptions options_;
    RadixTree radix_;
    std::vector<Bounds3> bounds_;           // of inner nodes
    std::vector<std::uint32_t> first_cell_; // of each edge; the last entry is the number of cells
};

// Goes down the octree, an octant's bit at a time.
class Converter {
  public:
    Converter(const Octree& octree, std::span<const Bounds3> boxes, TreeWriter& writer)
        : octree_(octree), boxes_(boxes), writer_(writer) {}

    TreeWriter::Written cell(const Octree::Node& node) {
        if (!node.is_leaf()) return octants(node, 0, 8);
        const std::size_t at = writer_.next();
        auto written = writer_.halves(node.begin, node.end, [this](std::uint32_t place) -> const Bounds3& {
            return boxes_[octree_.order[place]];
        });
        return writer_.collapse(at, written, node.begin, node.count());
    }

  private:
    // The children among count octants from first on; there is at least one.
    TreeWriter::Written octants(const Octree::Node& node, int first, int count) {
        auto any = [&](int from) { return (node.child_mask >> from & ((1 << count / 2) - 1)) != 0; };
        if (count == 1) return cell(octree_.nodes[node.child(first)]);
        const int middle = first + count / 2;
        if (!any(first)) return octants(node, middle, count / 2);
        if (!any(middle)) return octants(node, first, count / 2);
        const std::size_t at = writer_.next();
        auto written = writer_.inner([&] { return octants(node, first, count / 2); },
                                     [&] { return octants(node, middle, count / 2); });
        const std::uint32_t begin = begin_of(node, first), end = end_of(node, first, count);
        return writer_.collapse(at, written, begin, end - begin);
    }
    std::uint32_t begin_of(const Octree::Node& node, int first) const {
        while (!node.has_child(first)) ++first;
        return octree_.nodes[node.child(first)].begin;
    }
    std::uint32_t end_of(const Octree::Node& node, int first, int count) const {
        int last = first + count - 1;
        while (!node.has_child(last)) --last;
        return octree_.nodes[node.child(last)].end;
    }

    const Octree& octree_;
    std::span<const Bounds3> boxes_;
    TreeWriter& writer_;
};

Tree build(const Primitives&, std::span<const Bounds3> boxes, const BuildOptions& options) {
    OctreeOptions cells;
    cells.leaf_size = std::clamp(options.leaf_size, 1u, Tree::max_leaf_size);
    return to_tree(build_octree(boxes, cells), boxes, options);
}

} // namespace

Octree build_octree(std::span<const Bounds3> boxes, const OctreeOptions& options) {
    auto keys = morton_keys(boxes, options.max_level);
    if (keys.empty()) return {};
    sort_by_code(keys);
    return OctreeBuilder(boxes, keys, options).build();
}

Tree to_tree(const Octree& octree, std::span<const Bounds3> boxes, const BuildOptions& options) {
    Tree tree;
    if (octree.nodes.empty()) return tree;
    tree.order = octree.order;
    TreeWriter writer(tree, options);
    Converter(octree, boxes, writer).cell(octree.nodes[0]);
    return tree;
}

AccelBuilder octree_builder() {
    return {"octree", "octree from Morton codes, all cells at once (Karras 2012)", build};
}

} // namespace alhazen
