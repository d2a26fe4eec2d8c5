/// Builds trees by the surface area heuristic that may cut primitives (spatial.h): Stich, Friedrich and
/// Dietrich 2009, "Spatial Splits in Bounding Volume Hierarchies".
///
/// How many pieces there may be is bounded: a node's allowance is divided between its children in proportion
/// to their references, so that the result does not depend on which child is built first.
#include "accel/build/spatial.h"
#include "accel/build/top_down.h"
#include "accel/list.h"

namespace alhazen {

namespace {

Tree build(const Primitives& primitives, std::span<const Bounds3> boxes, const BuildOptions& options) {
    ReferenceList list = make_references(boxes, std::max(0.0f, options.extra_references));
    if (list.count == 0) return {};
    SpatialSplitter splitter(primitives, boxes, list.extent.box);
    // The builder for the best trees does not leave the last splits out.
    BuildOptions careful = options;
    careful.joined = 0;
    return build_top_down(std::move(list), careful, &splitter);
}

} // namespace

AccelBuilder sbvh_builder() {
    return {"sbvh", "surface area heuristic with spatial splits (Stich et al. 2009)", build};
}

} // namespace alhazen
