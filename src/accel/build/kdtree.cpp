/// Builds k-d trees whose planes halve space.
///
/// Karras 2012, "Maximizing Parallelism in the Construction of BVHs, Octrees, and k-d Trees": the radix tree
/// of points' Morton codes is a k-d tree of these points. A node's common prefix says in which cell of
/// space all its points are, and the bit behind the prefix halves that cell, in x, y and z by turns. Halvings
/// that would leave one side without points are passed over, since there the codes have no branch.
///
/// The paper's points become triangles here: planes are found from the centroids, all at once; then the
/// triangles go down to every cell they enter, and where a plane cuts one, each side goes on with its part of
/// it. How often that may happen is bounded: a subtree is allowed a number of references in proportion to
/// what it begins with. Going up again, cells that are cheaper as one leaf become one.
///
/// On a GPU the first half would take one pass and the second one pass for each level. On a CPU it is a
/// recursion by tasks, so the independence of the nodes is of use only to the first half. And since every
/// walk here tests boxes, not planes, what a k-d tree is loved for, stopping at the first leaf with a hit
/// because cells do not overlap, comes only as far as the boxes, fitted to the parts inside the cells, do not
/// overlap either.
#include "accel/build/kdtree.h"

#include "accel/build/clip.h"
#include "accel/build/radix_tree.h"
#include "accel/build/tree_writer.h"
#include "accel/list.h"

namespace alhazen {

namespace {

// Cells with so many references are worth a task of their own.
constexpr std::size_t task_size = 8192;

// What of a primitive is inside a cell, without padding.
struct Part {
    Bounds3 bounds;
    std::uint32_t primitive;
};

class KdBuilder {
  public:
    KdBuilder(const Primitives& primitives, std::span<const Bounds3> boxes, const BuildOptions& options,
              const KdOptions& kd_options, const MortonCoder& coder, std::span<const MortonKey> keys)
        : primitives_(primitives), boxes_(boxes), options_(options), kd_options_(kd_options),
          grid_(coder.grid()), radix_(keys) {}

    KdTree build() const {
        std::vector<Part> parts;
        KdTree tree;
        for (const MortonKey& key : radix_.keys()) {
            Bounds3 box = primitives_.bounds(key.index);
            parts.push_back({box, key.index});
            tree.cell.extend(box);
        }
        const double budget =
            static_cast<double>(kd_options_.max_references) * static_cast<double>(parts.size());
        const std::uint32_t root = radix_.inner() ? 0 : RadixTree::none;
        divide({root, tree.cell, static_cast<std::size_t>(budget)}, std::move(parts), tree);
        return tree;
    }

  private:
    struct Cell {
        std::uint32_t radix; // inner node of the radix tree whose plane is next; none: no more planes
        Bounds3 box;
        std::size_t budget; // of references
    };
    struct Plane {
        int axis;
        float position;
    };

    // Appends the cell's subtree to tree and returns its cost (area times tests).
    float divide(const Cell& cell, std::vector<Part>&& parts, KdTree& tree) const {
        const std::size_t node = tree.nodes.size(), reference = tree.references.size();
        const Plane plane = next_plane(cell.radix);
        if (plane.axis == KdTree::leaf_axis || parts.size() <= 1) return make_leaf(parts, tree);
        Cell below = cell, above = cell;
        below.box.hi[plane.axis] = above.box.lo[plane.axis] = plane.position;
        std::vector<Part> parts_below, parts_above;
        for (const Part& part : parts) deal(part, plane, below.box, above.box, parts_below, parts_above);
        const std::size_t total = parts_below.size() + parts_above.size();
        if (total > cell.budget) return make_leaf(parts, tree);
        below.budget = share(cell.budget, parts_below.size(), total);
        above.budget = cell.budget - below.budget;
        const RadixTree::Node n = radix_.node(cell.radix);
        below.radix = n.split == n.first ? RadixTree::none : n.split;
        above.radix = n.split + 1 == n.last ? RadixTree::none : n.split + 1;

        tree.nodes.push_back({plane.position, 0, 0, static_cast<std::uint8_t>(plane.axis)});
        const float cost =
            divide_children(below, above, std::move(parts_below), std::move(parts_above), tree);
        const float area = area_of(parts);
        const float split_cost = area * options_.node_cost + cost;
        if (parts.size() > std::min(options_.leaf_size, Tree::max_leaf_size)) return split_cost;
        if (!(area * tests(parts.size()) <= split_cost)) return split_cost;
        tree.nodes.resize(node);
        tree.references.resize(reference);
        return make_leaf(parts, tree);
    }

    // The children of the node written last.
    float divide_children(const Cell& below, const Cell& above, std::vector<Part>&& parts_below,
                          std::vector<Part>&& parts_above, KdTree& tree) const {
        const std::size_t node = tree.nodes.size() - 1;
        float cost_below = 0, cost_above = 0;
        if (parts_below.size() + parts_above.size() < task_size) {
            cost_below = divide(below, std::move(parts_below), tree);
            tree.nodes[node].first_or_above = static_cast<std::uint32_t>(tree.nodes.size());
            cost_above = divide(above, std::move(parts_above), tree);
            return cost_below + cost_above;
        }
        KdTree trees[2];
        parallel_invoke([&] { cost_below = divide(below, std::move(parts_below), trees[0]); },
                        [&] { cost_above = divide(above, std::move(parts_above), trees[1]); });
        append(trees[0], tree);
        tree.nodes[node].first_or_above = static_cast<std::uint32_t>(tree.nodes.size());
        append(trees[1], tree);
        return cost_below + cost_above;
    }
    static void append(const KdTree& part, KdTree& tree) {
        const auto nodes = static_cast<std::uint32_t>(tree.nodes.size());
        const auto references = static_cast<std::uint32_t>(tree.references.size());
        for (KdTree::Node n : part.nodes) {
            n.first_or_above += n.is_leaf() ? references : nodes;
            tree.nodes.push_back(n);
        }
        tree.references.insert(tree.references.end(), part.references.begin(), part.references.end());
    }

    Plane next_plane(std::uint32_t radix) const {
        if (radix == RadixTree::none) return {KdTree::leaf_axis, 0};
        const int bits = 3 * kd_options_.bits;
        const int prefix = radix_.common_bits(radix) - (64 - bits);
        if (prefix >= bits) return {KdTree::leaf_axis, 0}; // codes are the same: no plane tells them apart
        // The first code of the upper half.
        const int bit = bits - 1 - prefix;
        const std::uint64_t code = radix_.keys()[radix_.node(radix).last].code >> bit << bit;
        const int axis = 2 - bit % 3;
        return {axis, grid_.lower_side(code, axis)};
    }

    // Gives a part to the sides it is on; one that only touches the plane is on one side.
    void deal(const Part& part, const Plane& plane, const Bounds3& below, const Bounds3& above,
              std::vector<Part>& parts_below, std::vector<Part>& parts_above) const {
        if (part.bounds.lo[plane.axis] >= plane.position) {
            parts_above.push_back(part);
        } else if (part.bounds.hi[plane.axis] <= plane.position) {
            parts_below.push_back(part);
        } else {
            const Bounds3 lower = clipped(part, below), upper = clipped(part, above);
            // Rounding may lose a part that is smaller than it; then all of the rest is on the other side.
            if (!lower.empty() || upper.empty())
                parts_below.push_back({lower.empty() ? part.bounds : lower, part.primitive});
            if (!upper.empty() || lower.empty())
                parts_above.push_back({upper.empty() ? part.bounds : upper, part.primitive});
        }
    }
    Bounds3 clipped(const Part& part, const Bounds3& cell) const {
        if (primitives_.kind(part.primitive) != PrimitiveKind::custom)
            return clipped_bounds(primitives_.corners(part.primitive), cell);
        return {max(part.bounds.lo, cell.lo), min(part.bounds.hi, cell.hi)};
    }

    float make_leaf(const std::vector<Part>& parts, KdTree& tree) const {
        KdTree::Node leaf;
        leaf.first_or_above = static_cast<std::uint32_t>(tree.references.size());
        leaf.count = static_cast<std::uint32_t>(parts.size());
        tree.nodes.push_back(leaf);
        for (const Part& part : parts) tree.references.push_back({padded_part(part), part.primitive});
        return area_of(parts) * tests(parts.size());
    }
    // A test loses as much on a part as on the whole.
    Bounds3 padded_part(const Part& part) const {
        const Bounds3 whole = primitives_.bounds(part.primitive), &box = boxes_[part.primitive];
        const Vec3 pad = max(whole.lo - box.lo, box.hi - whole.hi);
        constexpr float largest = std::numeric_limits<float>::max();
        const Vec3 limit{largest, largest, largest};
        return {max(part.bounds.lo - pad, -limit), min(part.bounds.hi + pad, limit)};
    }

    static float area_of(const std::vector<Part>& parts) {
        Bounds3 box;
        for (const Part& part : parts) box.extend(part.bounds);
        return box.half_area();
    }
    float tests(std::size_t count) const {
        const std::size_t blocks = (count + options_.block - 1) / options_.block;
        return static_cast<float>(blocks);
    }
    // What is left over is shared in proportion.
    static std::size_t share(std::size_t budget, std::size_t own, std::size_t total) {
        if (total == 0) return 0;
        const double rest = static_cast<double>(budget - total);
        return own + static_cast<std::size_t>(rest * (static_cast<double>(own) / static_cast<double>(total)));
    }

    const Primitives& primitives_;
    std::span<const Bounds3> boxes_;
    BuildOptions options_;
    KdOptions kd_options_;
    MortonGrid grid_;
    RadixTree radix_;
};

// Leaves out empty cells. What is too much for a leaf is halved in the order in which it stands.
class Converter {
  public:
    Converter(const KdTree& kdtree, TreeWriter& writer) : kdtree_(kdtree), writer_(writer) {
        is_empty_.resize(kdtree.nodes.size());
        for (std::size_t i = kdtree.nodes.size(); i-- > 0;) {
            const KdTree::Node& n = kdtree.nodes[i];
            is_empty_[i] = n.is_leaf() ? n.count == 0 : is_empty_[i + 1] && is_empty_[n.first_or_above];
        }
    }
    bool is_empty(std::size_t node) const { return is_empty_[node]; }

    /// For a subtree that is not empty.
    TreeWriter::Written write(std::size_t i) {
        const KdTree::Node& n = kdtree_.nodes[i];
        if (n.is_leaf())
            return writer_.halves(
                n.first_or_above, n.first_or_above + n.count,
                [this](std::uint32_t k) -> const Bounds3& { return kdtree_.references[k].bounds; });
        if (is_empty_[i + 1]) return write(n.first_or_above);
        if (is_empty_[n.first_or_above]) return write(i + 1);
        return writer_.inner([&] { return write(i + 1); }, [&] { return write(n.first_or_above); });
    }

  private:
    const KdTree& kdtree_;
    TreeWriter& writer_;
    std::vector<bool> is_empty_;
};

Tree build(const Primitives& primitives, std::span<const Bounds3> boxes, const BuildOptions& options) {
    return to_tree(build_kdtree(primitives, boxes, options), options);
}

} // namespace

KdTree build_kdtree(const Primitives& primitives, std::span<const Bounds3> boxes, const BuildOptions& options,
                    const KdOptions& kd_options) {
    MortonCoder coder(boxes, kd_options.bits);
    if (coder.count() == 0) return {};
    std::vector<MortonKey> keys(coder.count());
    coder.write(keys);
    sort_by_code(keys);
    return KdBuilder(primitives, boxes, options, kd_options, coder, keys).build();
}

Tree to_tree(const KdTree& kdtree, const BuildOptions& options) {
    Tree tree;
    TreeWriter writer(tree, options);
    Converter converter(kdtree, writer);
    if (kdtree.nodes.empty() || converter.is_empty(0)) return tree;
    tree.order.reserve(kdtree.references.size());
    for (const KdTree::Reference& r : kdtree.references) tree.order.push_back(r.primitive);
    converter.write(0);
    return tree;
}

AccelBuilder kdtree_builder() {
    return {"kdtree", "k-d tree of halvings from Morton codes, primitives split (Karras 2012)", build};
}

} // namespace alhazen
