#include "accel/wide/layout.h"

#include <cstring>
#include <numeric>
#include <stdexcept>

#include "base/threads.h"

namespace alhazen {

namespace {

// Kernels read whole registers, and fetch whole nodes ahead.
constexpr std::size_t slack = 512;
// Places of a node that are not used refer to a leaf without a primitive. Only rays that are too extreme for
// box tests come there.
constexpr std::uint32_t null_leaf = wide_unit | wide_leaf | wide_other;

constexpr std::size_t round_up(std::size_t n, std::size_t unit) {
    return (n + unit - 1) / unit * unit;
}

// The different primitives of a run of the order: where primitives were split, two pieces may meet in a leaf
// again.
class LeafContents {
  public:
    LeafContents(const Tree& tree, const Primitives& primitives, const WideLeaf& leaf)
        : is_custom_(leaf.is_custom) {
        for (std::uint32_t i = 0; i < leaf.count; ++i) {
            const std::uint32_t p = tree.order[leaf.first + i];
            if ((primitives.kind(p) == PrimitiveKind::custom) != leaf.is_custom) continue;
            if (std::find(primitive_, primitive_ + count_, p) != primitive_ + count_) continue;
            primitive_[count_++] = p;
            is_filtered_ |= primitives.kind(p) == PrimitiveKind::filtered_triangle;
        }
    }
    /// In memory, and as a reference to that.
    std::size_t bytes() const {
        return round_up((is_custom_ ? 4 : 40) * std::size_t{count_} + (is_plain() ? 0 : 4), wide_unit);
    }
    std::uint32_t reference_at(std::size_t address) const {
        const std::uint32_t kind = is_plain() ? (count_ - 1) << wide_count_shift : std::uint32_t{wide_other};
        return static_cast<std::uint32_t>(address) | wide_leaf | kind;
    }
    void write(char* at, const Primitives& primitives) const {
        if (!is_plain()) {
            *reinterpret_cast<std::uint32_t*>(at) =
                count_ | (is_filtered_ ? std::uint32_t{wide_filtered} : 0u);
            at += 4;
        }
        auto* numbers = reinterpret_cast<std::uint32_t*>(at) + (is_custom_ ? 0u : 9 * count_);
        auto* coordinates = reinterpret_cast<float*>(at);
        for (std::uint32_t i = 0; i < count_; ++i) {
            numbers[i] = primitive_[i];
            if (is_custom_) continue;
            if (is_filtered_ && primitives.kind(primitive_[i]) == PrimitiveKind::filtered_triangle)
                numbers[i] |= wide_filtered;
            const Corners t = primitives.corners(primitive_[i]);
            const Vec3 corner[3] = {t.a, t.b, t.c};
            for (std::uint32_t c = 0; c < 3; ++c)
                for (std::uint32_t axis = 0; axis < 3; ++axis)
                    coordinates[(3 * c + axis) * count_ + i] = corner[c][static_cast<int>(axis)];
        }
    }

  private:
    bool is_plain() const { return !is_custom_ && !is_filtered_; }

    std::uint32_t primitive_[Tree::max_leaf_size];
    std::uint32_t count_ = 0;
    bool is_custom_, is_filtered_ = false;
};

// Where everything is written, decided before anything is written.
class Placement {
  public:
    Placement(const Tree& tree, const Primitives& primitives, const CollapsedTree& collapsed)
        : tree_(tree), primitives_(primitives), next_(2 * wide_unit) {
        if (collapsed.single_leaf.count > 0) {
            root = place_leaf(collapsed.single_leaf);
            return;
        }
        root = static_cast<std::uint32_t>(round_up(next_, alignof(WideNode)));
        references.resize(collapsed.nodes.size());
        at.resize(collapsed.nodes.size());
        // A node's leaves follow it, so that they are fetched from the same page.
        for (std::size_t i = 0; i < collapsed.nodes.size(); ++i) {
            at[i] = next_ = round_up(next_, alignof(WideNode));
            next_ += sizeof(WideNode);
            for (std::size_t k = 0; k < static_cast<std::size_t>(collapsed.nodes[i].count); ++k)
                if (collapsed.nodes[i].child[k].is_leaf())
                    references[i][k] = place_leaf(collapsed.nodes[i].child[k].leaf);
        }
        for (std::size_t i = 0; i < collapsed.nodes.size(); ++i)
            for (std::size_t k = 0; k < static_cast<std::size_t>(collapsed.nodes[i].count); ++k)
                if (!collapsed.nodes[i].child[k].is_leaf())
                    references[i][k] = static_cast<std::uint32_t>(at[collapsed.nodes[i].child[k].node]);
        if (next_ > wide_address) throw std::length_error("an object of more than 4 GB of triangles");
    }

    std::size_t bytes() const { return next_; }
    std::uint32_t root;
    std::vector<std::array<std::uint32_t, 8>> references; // of the nodes' children
    std::vector<std::size_t> at;                          // of the nodes

  private:
    std::uint32_t place_leaf(const WideLeaf& leaf) {
        const LeafContents contents(tree_, primitives_, leaf);
        const std::uint32_t reference = contents.reference_at(next_);
        next_ += contents.bytes();
        return reference;
    }

    const Tree& tree_;
    const Primitives& primitives_;
    std::size_t next_;
};

// In which order a ray of each of four octants of directions meets the children, farthest first; the other
// four meet them the other way round. Octants: y and z backwards or not, x forwards.
void write_orders(WideNode& node, const CollapsedNode& from) {
    for (std::uint32_t octant = 0; octant < 4; ++octant) {
        const Vec3 direction{1, octant & 1 ? -1.0f : 1.0f, octant & 2 ? -1.0f : 1.0f};
        std::array<float, 8> distance;
        distance.fill(-infinity);
        for (std::size_t k = 0; k < static_cast<std::size_t>(from.count); ++k) {
            const Bounds3& b = from.child[k].bounds;
            distance[k] = dot(direction, b.lo * 0.5f + b.hi * 0.5f);
        }
        std::array<std::uint32_t, 8> place;
        std::iota(place.begin(), place.end(), 0u);
        std::stable_sort(place.begin(), place.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return distance[a] > distance[b]; });
        std::uint32_t bits = 0;
        for (std::uint32_t i = 0; i < 8; ++i) bits |= place[i] << (3 * i);
        for (std::uint32_t byte = 0; byte < 3; ++byte)
            node.order[octant][byte] = static_cast<std::uint8_t>(bits >> (8 * byte));
    }
}

void write_node(WideNode& node, const CollapsedNode& from, const std::array<std::uint32_t, 8>& references) {
    constexpr float nowhere = std::numeric_limits<float>::max();
    for (std::size_t k = 0; k < 8; ++k) {
        const bool is_used = k < static_cast<std::size_t>(from.count);
        node.child[k] = is_used ? references[k] : null_leaf;
        for (int axis = 0; axis < 3; ++axis) {
            node.planes[axis][0][k] = is_used ? from.child[k].bounds.lo[axis] : nowhere;
            node.planes[axis][1][k] = is_used ? from.child[k].bounds.hi[axis] : -nowhere;
        }
    }
    write_orders(node, from);
}

} // namespace

WideLayout::WideLayout(const Tree& tree, const Primitives& primitives) {
    if (tree.nodes.empty()) return;
    const CollapsedTree collapsed = collapse(tree, primitives, wide_costs, wide_stack - 8);
    const Placement placement(tree, primitives, collapsed);
    memory_ = BigArray<char>(placement.bytes() + slack);
    root_ = placement.root;
    nodes_ = collapsed.nodes.size();
    depth_ = collapsed.depth;
    cost_ = collapsed.cost;
    auto write_leaf = [&](std::uint32_t reference, const WideLeaf& leaf) {
        LeafContents(tree, primitives, leaf).write(memory_.data() + (reference & wide_address), primitives);
    };
    *reinterpret_cast<std::uint32_t*>(memory_.data() + (null_leaf & wide_address)) = 0;
    if (collapsed.single_leaf.count > 0) write_leaf(root_, collapsed.single_leaf);
    parallel_for(collapsed.nodes.size(), 512, [&](std::size_t i) {
        const CollapsedNode& from = collapsed.nodes[i];
        write_node(*new (memory_.data() + placement.at[i]) WideNode, from, placement.references[i]);
        for (std::size_t k = 0; k < static_cast<std::size_t>(from.count); ++k)
            if (from.child[k].is_leaf()) write_leaf(placement.references[i][k], from.child[k].leaf);
    });
}

} // namespace alhazen
