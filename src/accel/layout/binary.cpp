#include "accel/layout/binary.h"

namespace alhazen {

BinaryLayout::BinaryLayout(const Tree& tree) {
    if (tree.nodes.empty()) return;
    depth = stats_of(tree).depth;
    // Leaves live in their parents, so only inner nodes are numbered.
    std::vector<std::uint32_t> place(tree.nodes.size());
    std::uint32_t inner = 0;
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        place[i] = inner;
        inner += !tree.nodes[i].is_leaf();
    }
    auto child_of = [&](std::size_t i) -> BinaryChild {
        const Tree::Node& n = tree.nodes[i];
        return n.is_leaf() ? BinaryChild{n.first_or_right, n.count} : BinaryChild{place[i], 0};
    };
    root = child_of(0);
    nodes.reserve(inner);
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        if (tree.nodes[i].is_leaf()) continue;
        BinaryNode node;
        const std::size_t children[2] = {i + 1, tree.nodes[i].first_or_right};
        for (int c = 0; c < 2; ++c) {
            const Bounds3& b = tree.nodes[children[c]].bounds;
            for (int axis = 0; axis < 3; ++axis) {
                node.slabs[axis][0][c] = b.lo[axis];
                node.slabs[axis][1][c] = b.hi[axis];
            }
            node.index[c] = child_of(children[c]).index;
            node.count[c] = child_of(children[c]).count;
        }
        nodes.push_back(node);
    }
}

} // namespace alhazen
