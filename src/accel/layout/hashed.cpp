#include "accel/layout/hashed.h"

namespace alhazen {

std::vector<PathHash::Entry> paths_of(const BinaryLayout& layout) {
    std::vector<PathHash::Entry> paths;
    std::vector<PathBits> key(layout.nodes.size(), 1);
    for (std::size_t i = 0; i < layout.nodes.size(); ++i)
        for (int side = 0; side < 2; ++side) {
            const BinaryChild child = layout.nodes[i].child(side);
            const PathBits path = key[i] << 1 | static_cast<PathBits>(side);
            if (child.count == 0) key[child.index] = path;
            paths.push_back({path, child});
        }
    return paths;
}

HashedLayout::HashedLayout(const Tree& tree) : binary(tree), by_path(paths_of(binary)) {}

} // namespace alhazen
