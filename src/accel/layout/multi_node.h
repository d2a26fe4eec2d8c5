/// Nodes of several children (multi bounding volume hierarchies) in plain floats: the planes of all children
/// side by side, so that one vector operation tests four of them.
///
///     width 4, 128 bytes, two cache lines:
///     byte  0         32        64        96      112
///           x slabs   y slabs   z slabs   index   count
///           lo4 hi4   lo4 hi4   lo4 hi4   0 1 2 3 0 1 2 3
#pragma once

#include "accel/box_ray.h"
#include "accel/layout/collapse.h"
#include "accel/structure.h"
#include "base/lanes.h"
#include "base/threads.h"

namespace alhazen {

/// A child: a leaf's range in the order, or a node.
struct MultiChild {
    std::uint32_t index; ///< leaf: first place in the order; else number of a node
    std::int32_t count;  ///< leaf: primitives; 0 for a node; no_child where there is none
    static constexpr std::int32_t no_child = -1;
    bool is_leaf() const { return count > 0; }
};

template <int width>
struct alignas(64) MultiNode {
    float slabs[3][2][width]; ///< axis; 0 lower, 1 upper; child
    std::uint32_t index[width];
    std::int32_t count[width];

    MultiChild child(int i) const { return {index[i], count[i]}; }
    Bounds3 bounds(int i) const {
        Bounds3 box;
        for (int axis = 0; axis < 3; ++axis) {
            box.lo[axis] = slabs[axis][0][i];
            box.hi[axis] = slabs[axis][1][i];
        }
        return box;
    }
};
static_assert(sizeof(MultiNode<4>) == 128 && sizeof(MultiNode<8>) == 256);

template <int width>
struct MultiLayout {
    std::vector<MultiNode<width>> nodes; ///< as in CollapsedTree, but for a root also above a single leaf
    int depth = 0;

    MultiLayout() = default;
    explicit MultiLayout(const Tree& tree)
        : MultiLayout(collapse(tree, costs_by_primitive, {.width = width})) {}
    /// wide: with at most width children a node.
    explicit MultiLayout(const CollapsedTree& wide) : nodes(wide.nodes.size()), depth(wide.depth) {
        parallel_for(nodes.size(), 1024, [&](std::size_t n) { write(nodes[n], wide.nodes[n].children()); });
    }
    LayoutStats stats() const { return {nodes.size(), depth, nodes.size() * sizeof(MultiNode<width>)}; }

  private:
    static void write(MultiNode<width>& node, std::span<const WideChild> children) {
        for (std::size_t i = 0; i < width; ++i) {
            const WideChild child = i < children.size() ? children[i] : WideChild{};
            for (int axis = 0; axis < 3; ++axis) {
                node.slabs[axis][0][i] = child.bounds.lo[axis];
                node.slabs[axis][1][i] = child.bounds.hi[axis];
            }
            node.index[i] = child.is_leaf() ? child.leaf.first : child.node;
            node.count[i] =
                i < children.size() ? static_cast<std::int32_t>(child.leaf.count) : MultiChild::no_child;
        }
    }
};

/// A ray against all children of a wide node.
template <int width>
class MultiTest {
  public:
    explicit MultiTest(const BoxRay& ray) : ray_(ray) {}

    /// The children that are hit, nearest first, of equally near ones the first. That order depends on the
    /// node and the ray only: a smaller tmax takes children off the end.
    struct Hits {
        int count = 0;
        struct Hit {
            float t;
            int child;
        } list[width];
    };
    Hits operator()(const MultiNode<width>& node, float tmax) const {
        Hits hits;
        for (int first = 0; first < width; first += 4) {
            Lanes4 entry = all_lanes(0), exit = all_lanes(tmax);
            for (int axis = 0; axis < 3; ++axis) {
                const int near = ray_.near_side[axis];
                const Lanes4 in = load(node.slabs[axis][near] + first);
                const Lanes4 out = load(node.slabs[axis][1 - near] + first);
                entry = max_lanes(in * ray_.enter_scale[axis] - ray_.enter_offset[axis], entry);
                exit = min_lanes(out * ray_.leave_scale[axis] - ray_.leave_offset[axis], exit);
            }
            const IntLanes4 hit = entry <= exit;
            for (int i = 0; i < 4; ++i)
                if (hit[i] && node.count[first + i] != MultiChild::no_child)
                    insert(hits, entry[i], first + i);
        }
        return hits;
    }

  private:
    static Lanes4 load(const float* from) {
        Lanes4 v;
        std::memcpy(&v, from, sizeof v);
        return v;
    }
    static void insert(Hits& hits, float t, int child) {
        int i = hits.count++;
        for (; i > 0 && hits.list[i - 1].t > t; --i) hits.list[i] = hits.list[i - 1];
        hits.list[i] = {t, child};
    }

    BoxRay ray_;
};

} // namespace alhazen
