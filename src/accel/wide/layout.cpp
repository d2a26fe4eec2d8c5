#include "accel/wide/layout.h"

#include <cstring>
#include <stdexcept>
#include <utility>

#include "base/threads.h"

namespace alhazen {

namespace {

// Kernels read whole registers, and fetch whole nodes ahead.
constexpr std::size_t slack = 512;
// Places of a node that are not used refer to a leaf without a primitive. Only rays that are too extreme for
// box tests come there.
constexpr std::uint32_t null_leaf = wide_unit | wide_leaf | wide_other;

// So many nodes before it is needed memory is asked for, three times one after the other (prefetch_corners).
constexpr std::size_t fetch_distance = 3;

constexpr std::size_t round_up(std::size_t n, std::size_t unit) {
    return (n + unit - 1) / unit * unit;
}

// The different primitives of a run of the order: where primitives were split, two pieces may meet in a leaf
// again.
class LeafContents {
  public:
    /// kinds: of all primitives; where there is one only, nobody has to ask for each.
    LeafContents(const Tree& tree, const Primitives& primitives, const PrimitiveKinds& kinds,
                 const WideLeaf& leaf)
        : is_custom_(leaf.is_custom) {
        for (std::uint32_t i = 0; i < leaf.count; ++i) {
            const std::uint32_t p = tree.order[leaf.first + i];
            if (std::find(primitive_, primitive_ + count_, p) != primitive_ + count_) continue;
            primitive_[count_++] = p;
            if (kinds.filtered_triangle && !is_custom_)
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
        std::copy_n(primitive_, count_, numbers);
        if (is_custom_) return;
        primitives.gather_corners({primitive_, count_}, reinterpret_cast<float*>(at));
        if (!is_filtered_) return;
        for (std::uint32_t i = 0; i < count_; ++i)
            if (primitives.kind(primitive_[i]) == PrimitiveKind::filtered_triangle)
                numbers[i] |= wide_filtered;
    }

  private:
    bool is_plain() const { return !is_custom_ && !is_filtered_; }

    std::uint32_t primitive_[Tree::max_leaf_size];
    std::uint32_t count_ = 0;
    bool is_custom_, is_filtered_ = false;
};

using Lanes8 = float __attribute__((vector_size(32)));
using IntLanes8 = int __attribute__((vector_size(32)));

// In which order a ray of each of four octants of directions meets the children, farthest first; the other
// four meet them the other way round. Octants: y and z backwards or not, x forwards.
void write_orders(WideNode& node, const CollapsedNode& from) {
    constexpr IntLanes8 number{0, 1, 2, 3, 4, 5, 6, 7};
    Lanes8 x{}, y{}, z{};
    for (int k = 0; k < from.count; ++k) {
        const Vec3 middle = from.child[static_cast<std::size_t>(k)].bounds.centroid();
        x[k] = middle.x, y[k] = middle.y, z[k] = middle.z;
    }
    const Lanes8 nowhere = Lanes8{} - infinity;
    for (std::uint32_t octant = 0; octant < 4; ++octant) {
        Lanes8 distance = x + (octant & 1 ? -y : y) + (octant & 2 ? -z : z);
        distance = number < from.count ? distance : nowhere;
        // How many are farther; of equal ones the first counts as such.
        IntLanes8 place{};
        for (int k = 0; k < 8; ++k)
            place -= (distance[k] > distance) | ((distance[k] == distance) & (k < number));
        std::uint32_t bits = 0;
        for (int k = 0; k < 8; ++k) bits |= static_cast<std::uint32_t>(k) << (3 * place[k]);
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

// Where everything stands: a node's leaves follow it, so that they are fetched from the same page.
class Writer {
  public:
    Writer(const Tree& tree, const Primitives& primitives, const CollapsedTree& collapsed)
        : tree_(tree), primitives_(primitives), kinds_(primitives.kinds()), collapsed_(collapsed),
          at_(collapsed.nodes.size() + 1) {
        const std::size_t count = collapsed.nodes.size();
        parallel_for(count, 512, [&](std::size_t i) {
            std::size_t bytes = sizeof(WideNode);
            for (const WideChild& child : collapsed.nodes[i].children())
                if (child.is_leaf()) bytes += contents(child.leaf).bytes();
            at_[i] = round_up(bytes, alignof(WideNode));
        });
        std::size_t next = round_up(2 * wide_unit, alignof(WideNode));
        for (std::size_t i = 0; i < count; ++i) next += std::exchange(at_[i], next);
        if (collapsed.single_leaf.count > 0) next += contents(collapsed.single_leaf).bytes();
        at_[count] = next;
        if (next > wide_address) throw std::length_error("an object of more than 4 GB of triangles");
    }

    std::size_t bytes() const { return at_.back(); }
    /// Writes everything; the root's reference.
    std::uint32_t write(char* memory) const {
        *reinterpret_cast<std::uint32_t*>(memory + (null_leaf & wide_address)) = 0;
        if (collapsed_.single_leaf.count > 0) {
            const std::size_t at = round_up(2 * wide_unit, alignof(WideNode));
            return write_leaf(memory, at, collapsed_.single_leaf).reference_at(at);
        }
        parallel_ranges(collapsed_.nodes.size(), 512, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                for (int step = 0; step < 3; ++step)
                    if (const std::size_t later = i + fetch_distance * static_cast<std::size_t>(3 - step);
                        later < end)
                        prefetch_triangles(collapsed_.nodes[later], step);
                write_node_at(memory, i);
            }
        });
        return static_cast<std::uint32_t>(at_[0]);
    }

  private:
    LeafContents contents(const WideLeaf& leaf) const { return {tree_, primitives_, kinds_, leaf}; }
    void prefetch_triangles(const CollapsedNode& node, int step) const {
        for (const WideChild& child : node.children())
            if (child.is_leaf() && !child.leaf.is_custom)
                primitives_.prefetch_corners({&tree_.order[child.leaf.first], child.leaf.count}, step);
    }
    LeafContents write_leaf(char* memory, std::size_t at, const WideLeaf& leaf) const {
        const LeafContents leaf_contents = contents(leaf);
        leaf_contents.write(memory + at, primitives_);
        return leaf_contents;
    }
    void write_node_at(char* memory, std::size_t i) const {
        const CollapsedNode& from = collapsed_.nodes[i];
        std::array<std::uint32_t, 8> references;
        std::size_t next = at_[i] + sizeof(WideNode);
        for (std::size_t k = 0; k < from.children().size(); ++k) {
            const WideChild& child = from.child[k];
            references[k] = static_cast<std::uint32_t>(at_[child.node]);
            if (!child.is_leaf()) continue;
            const LeafContents leaf = write_leaf(memory, next, child.leaf);
            references[k] = leaf.reference_at(next);
            next += leaf.bytes();
        }
        write_node(*new (memory + at_[i]) WideNode, from, references);
    }

    const Tree& tree_;
    const Primitives& primitives_;
    PrimitiveKinds kinds_;
    const CollapsedTree& collapsed_;
    std::vector<std::size_t> at_; // of the nodes, and the end
};

} // namespace

WideLayout::WideLayout(const Tree& tree, const Primitives& primitives) {
    if (tree.nodes.empty()) return;
    const CollapsedTree collapsed = collapse(tree, primitives, wide_costs, wide_stack - 8);
    const Writer writer(tree, primitives, collapsed);
    memory_ = BigArray<char>(writer.bytes() + slack);
    root_ = writer.write(memory_.data());
    nodes_ = collapsed.nodes.size();
    depth_ = collapsed.depth;
    cost_ = collapsed.cost;
}

} // namespace alhazen
