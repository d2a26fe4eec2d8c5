/// Trees from the top down: split a node's references in two where the surface area heuristic says, then
/// each half, until leaves are cheaper. The work that sah and sbvh share.
#pragma once

#include "accel/build/references.h"
#include "accel/build/tree.h"

namespace alhazen {

class SpatialSplitter;

/// The tree over the list's references; its bits do not depend on the number of threads. Splits space as well
/// where there is a splitter, as far as the list has room.
Tree build_top_down(ReferenceList list, const BuildOptions& options,
                    const SpatialSplitter* spatial = nullptr);

} // namespace alhazen
