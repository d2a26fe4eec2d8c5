#include "accel/leaf_store.h"

#include "base/threads.h"

namespace alhazen {

LeafStore::LeafStore(const Tree& tree, const Primitives& primitives) : entries(tree.order.size()) {
    parallel_for(entries.size(), 4096, [&](std::size_t i) {
        Entry& entry = entries[i];
        entry.primitive = tree.order[i];
        entry.kind = primitives.kind(entry.primitive);
        if (entry.kind != PrimitiveKind::custom) entry.corners = primitives.corners(entry.primitive);
    });
}

} // namespace alhazen
