/// Builds trees by the surface area heuristic over bins.
///
/// Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies": the centroids of a node's
/// primitives are counted into a few bins along each axis; of the planes between bins the one is taken that
/// makes (area of the left box x primitives in it) + (the same on the right) least, since a random ray that
/// meets the node meets a child with probability proportional to the child's area.
#pragma once

#include <span>

#include "accel/build/tree.h"

namespace alhazen {

struct SahOptions {
    /// Cost of visiting a node over the cost of testing one primitive.
    float node_cost = 1.0f;
    /// A node with so many primitives or fewer may become a leaf (1 ... Tree::max_leaf_size).
    std::uint32_t leaf_size = 4;
};

/// The tree over the boxes; its bits do not depend on the number of threads. Boxes that are empty, infinite
/// or NaN are left out. Takes O(n log n) time for any input.
Tree build_sah(std::span<const Bounds3> boxes, const SahOptions& options = {});

} // namespace alhazen
