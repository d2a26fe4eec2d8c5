#include "lab/peer.h"

namespace alhazen {

bool is_mesh(const Object& root) {
    for (std::uint32_t i = 0; i < root.count(); ++i)
        if (root.kind(i) == PrimitiveKind::custom) return false;
    return root.count() > 0;
}

} // namespace alhazen
