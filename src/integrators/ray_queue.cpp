#include "integrators/ray_queue.h"

namespace alhazen {

void RayQueue::trace_closest(const Scene& scene) {
    if (found_.size() < traced_.rays.size()) found_.resize(traced_.rays.size());
    hits_.assign(traced_.rays.size(), Intersection{});
    scene.closest(traced_.rays, hits_, {found_.data(), traced_.rays.size()});
}

void RayQueue::trace_shadows(const Scene& scene) {
    blocked_.resize(traced_.rays.size());
    scene.blocked(traced_.rays, blocked_);
}

} // namespace alhazen
