/// Which builders and walks there are. A new one is a file and a line here.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "accel/structure.h"

namespace alhazen {

/// A way to build trees.
struct AccelBuilder {
    std::string_view name;  ///< as chosen on the command line
    std::string_view about; ///< one line
    /// boxes: as padded_boxes gives them; those that are empty are left out of the tree. The tree's bits do
    /// not depend on the number of threads.
    Tree (*build)(const Primitives& primitives, std::span<const Bounds3> boxes, const BuildOptions& options);
};

/// What a walk may be told.
struct WalkOptions {
    int stack_entries = 8; ///< of the short stack, for walks that have one (1 ... 64)
    /// For walks with kernels for several instruction sets: which to use; empty: the best this processor has.
    std::string_view instructions = {};
};

/// A layout of trees in memory, and a walk through it.
struct AccelWalk {
    std::string_view name;
    std::string_view about;
    BuildOptions wants; ///< what suits the layout best
    std::unique_ptr<Structure> (*make)(const Primitives& primitives, const Tree& tree,
                                       const WalkOptions& options);
};

AccelBuilder sah_builder();
AccelBuilder sbvh_builder();
AccelBuilder lbvh_builder();
AccelBuilder octree_builder();
AccelBuilder kdtree_builder();
AccelBuilder ploc_builder();

AccelWalk stack_walk();
AccelWalk wide_walk();
AccelWalk guthe_walk();
AccelWalk stackless_walk();
AccelWalk cwbvh_walk();
AccelWalk shortstack_walk();

/// All of them, in the order in which they are documented.
std::span<const AccelBuilder> accel_builders();
std::span<const AccelWalk> accel_walks();

} // namespace alhazen
