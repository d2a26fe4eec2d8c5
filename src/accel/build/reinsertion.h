/// Improves finished trees by taking subtrees out and putting them back where they cost less (Meister and
/// Bittner 2018, "Parallel Reinsertion for Bounding Volume Hierarchy Optimization").
#pragma once

#include "accel/build/tree.h"

namespace alhazen {

struct ReinsertionOptions {
    /// Rounds at most; in each, one of stride nodes looks for a better place, in turn.
    int rounds = 12;
    std::uint32_t stride = 2;
    /// The end comes when as many rounds as there are strides together lower the cost by less than this
    /// share.
    double least_gain = 0.005;
    /// Nodes that a search visits at most.
    int visits = 400;
};

/// Changes the tree's shape, never its leaves. The cost of the surface area heuristic does not rise, no path
/// gets longer than Tree::max_depth, and the result does not depend on the number of threads. Trees of
/// single primitives gain most: build them so, and collapse_leaves() afterwards.
void optimize_by_reinsertion(Tree& tree, const ReinsertionOptions& options = {});

} // namespace alhazen
