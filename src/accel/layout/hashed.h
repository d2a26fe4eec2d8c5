/// Binary nodes that can also be found by their path from the root.
#pragma once

#include "accel/layout/path_hash.h"

namespace alhazen {

struct HashedLayout {
    BinaryLayout binary;
    PathHash by_path; ///< all nodes and leaves but the root

    HashedLayout() = default;
    explicit HashedLayout(const Tree& tree);
    LayoutStats stats() const {
        LayoutStats stats = binary.stats();
        stats.bytes += by_path.bytes();
        return stats;
    }
};

/// The nodes and leaves below the root with their keys, parents first.
std::vector<PathHash::Entry> paths_of(const BinaryLayout& layout);

} // namespace alhazen
