/// Builds trees by the surface area heuristic over bins (binning.h): Wald 2007, "On fast Construction of
/// SAH-based Bounding Volume Hierarchies".
#include "accel/build/top_down.h"
#include "accel/list.h"

namespace alhazen {

namespace {

Tree build(const Primitives&, std::span<const Bounds3> boxes, const BuildOptions& options) {
    return build_top_down(make_references(boxes), options);
}

} // namespace

AccelBuilder sah_builder() {
    return {"sah", "surface area heuristic over bins (Wald 2007)", build};
}

} // namespace alhazen
