#include "accel/layout/compressed.h"

#include <cmath>

#include "base/threads.h"

namespace alhazen {

namespace {

constexpr int slots = CompressedNode::slots;

Bounds3 bounds_of(std::span<const WideChild> children) {
    Bounds3 box;
    for (const WideChild& child : children) box.extend(child.bounds);
    return box;
}

// Sets one axis of the grid and the children's planes on it, in the finest steps in which all fit. plane() is
// checked as it will be computed, so that its rounding is covered.
bool quantize(CompressedNode& node, int axis, std::span<const WideChild> children,
              std::span<const int> slot_of) {
    const double step = static_cast<double>(node.step(axis)), origin = static_cast<double>(node.origin[axis]);
    for (std::size_t i = 0; i < children.size(); ++i) {
        const int slot = slot_of[i];
        const float lo = children[i].bounds.lo[axis], hi = children[i].bounds.hi[axis];
        std::uint8_t& lower = node.planes[0][axis][slot];
        std::uint8_t& upper = node.planes[1][axis][slot];
        const double low = std::floor((static_cast<double>(lo) - origin) / step);
        const double high = std::ceil((static_cast<double>(hi) - origin) / step);
        if (!(low < 256 && high < 256)) return false;
        lower = static_cast<std::uint8_t>(low);
        upper = static_cast<std::uint8_t>(high);
        while (node.plane(0, axis, slot) > lo) --lower;
        while (node.plane(1, axis, slot) < hi)
            if (++upper == 0) return false;
    }
    return true;
}

void set_grid(CompressedNode& node, std::span<const WideChild> children, std::span<const int> slot_of) {
    const Bounds3 box = bounds_of(children);
    for (int axis = 0; axis < 3; ++axis) {
        node.origin[axis] = box.lo[axis];
        const double extent = static_cast<double>(box.hi[axis]) - static_cast<double>(box.lo[axis]);
        const int exponent = extent > 0 ? std::ilogb(extent / 255) : -200;
        node.exponent[axis] = static_cast<std::uint8_t>(std::clamp(exponent + 127, 1, 254));
        while (!quantize(node, axis, children, slot_of)) ++node.exponent[axis];
    }
}

struct Pending {
    std::uint32_t wide, node;
};

// Children that are nodes get the numbers from next_node on, in the order of their slots.
void fill(CompressedNode& node, std::span<const WideChild> children, const std::array<int, slots>& slot_of,
          std::span<const std::uint32_t> order, CompressedLayout& layout, std::uint32_t& next_node,
          std::vector<Pending>& stack) {
    node = {};
    set_grid(node, children, slot_of);
    node.first_child = next_node;
    node.first_primitive = static_cast<std::uint32_t>(layout.order.size());
    std::array<int, slots> child_in;
    child_in.fill(-1);
    for (std::size_t i = 0; i < children.size(); ++i)
        child_in[static_cast<std::size_t>(slot_of[i])] = static_cast<int>(i);
    const std::size_t first = stack.size();
    for (std::size_t slot = 0; slot < slots; ++slot) {
        if (child_in[slot] < 0) continue;
        const WideChild& child = children[static_cast<std::size_t>(child_in[slot])];
        if (child.is_leaf()) {
            const std::size_t place = layout.order.size() - node.first_primitive;
            node.meta[slot] = static_cast<std::uint8_t>(((1u << child.leaf.count) - 1) << 5 | place);
            auto primitives = order.subspan(child.leaf.first, child.leaf.count);
            layout.order.insert(layout.order.end(), primitives.begin(), primitives.end());
        } else {
            node.inner_mask = static_cast<std::uint8_t>(node.inner_mask | 1u << slot);
            node.meta[slot] = static_cast<std::uint8_t>(1u << 5 | (24 + slot));
            stack.push_back({child.node, next_node++});
        }
    }
    std::reverse(stack.begin() + static_cast<std::ptrdiff_t>(first), stack.end());
}

// How many members each set of slots has. (Without the processor's instruction for it, to count takes longer
// than all else here.)
constexpr auto members = [] {
    std::array<std::uint8_t, 1u << slots> counts{};
    for (unsigned set = 1; set < counts.size(); ++set)
        counts[set] = static_cast<std::uint8_t>(counts[set / 2] + set % 2);
    return counts;
}();

} // namespace

std::array<int, slots> assign_slots(std::span<const WideChild> children) {
    const Vec3d center(bounds_of(children).centroid());
    // Of each child in each slot.
    std::array<std::array<double, slots>, slots> costs;
    for (std::size_t i = 0; i < children.size(); ++i) {
        const Vec3d d = Vec3d(children[i].bounds.centroid()) - center;
        for (std::size_t slot = 0; slot < slots; ++slot)
            costs[i][slot] = (slot & 1 ? -d.x : d.x) + (slot & 2 ? -d.y : d.y) + (slot & 4 ? -d.z : d.z);
    }
    constexpr std::size_t sets = 1u << slots;
    // The least cost of seating the first children, as many as the set has members, in a set of slots; and
    // the slot of the last of them.
    std::array<double, sets> best;
    std::array<int, sets> last;
    best.fill(static_cast<double>(infinity));
    best[0] = 0;
    for (unsigned set = 0; set < sets; ++set) {
        const std::size_t i = members[set];
        if (i >= children.size()) continue;
        for (unsigned free = ~set & (sets - 1); free != 0; free &= free - 1) {
            const int slot = std::countr_zero(free);
            const double cost = best[set] + costs[i][static_cast<std::size_t>(slot)];
            const unsigned with = set | 1u << slot;
            if (cost < best[with]) {
                best[with] = cost;
                last[with] = slot;
            }
        }
    }
    unsigned set = 0;
    double least = static_cast<double>(infinity);
    for (unsigned s = 0; s < sets; ++s)
        if (members[s] == children.size() && best[s] < least) {
            least = best[s];
            set = s;
        }
    std::array<int, slots> slot_of{};
    for (std::size_t i = children.size(); i-- > 0;) {
        slot_of[i] = last[set];
        set &= ~(1u << last[set]);
    }
    return slot_of;
}

CompressedLayout::CompressedLayout(const Tree& tree) {
    const CollapsedTree wide = collapse(tree, costs_by_primitive, {.leaf_size = CompressedNode::max_leaf});
    depth = wide.depth;
    nodes.resize(wide.nodes.size());
    order.reserve(tree.order.size());
    if (nodes.empty()) return;
    // Most of the work, and each node's its own.
    std::vector<std::array<int, slots>> slots_of(wide.nodes.size());
    parallel_for(slots_of.size(), 64,
                 [&](std::size_t i) { slots_of[i] = assign_slots(wide.nodes[i].children()); });
    std::uint32_t next_node = 1;
    std::vector<Pending> stack{{0, 0}};
    while (!stack.empty()) {
        const Pending p = stack.back();
        stack.pop_back();
        fill(nodes[p.node], wide.nodes[p.wide].children(), slots_of[p.wide], tree.order, *this, next_node,
             stack);
    }
}

} // namespace alhazen
