/// Structures over compressed nodes, which keep primitives in an order of their own.
#pragma once

#include "accel/layout/compressed.h"
#include "accel/walk/walk_structure.h"

namespace alhazen {

/// Walk::Layout is made from (CompressedLayout, more...).
template <class Walk, class... More>
std::unique_ptr<Structure> make_compressed(const Primitives& primitives, const Tree& tree, More... more) {
    CompressedLayout layout(tree);
    Tree rearranged;
    if (!tree.nodes.empty()) rearranged.nodes.push_back(tree.nodes[0]);
    rearranged.order = std::move(layout.order);
    return std::make_unique<WalkStructure<Walk>>(primitives, rearranged,
                                                 typename Walk::Layout{std::move(layout), more...});
}

} // namespace alhazen
