#include "integrators/ray_queue.h"

namespace alhazen {

void RayQueue::trace(const Scene& scene, Kind kind) {
    const std::vector<Ray>& rays = traced_.rays;
    const DistanceScene* approximation = scene.approximation();
    if (kind == shadow) {
        blocked_.resize(rays.size());
        if (approximation) return approximation->blocked(rays, blocked_);
        return scene.blocked(rays, blocked_);
    }
    if (found_.size() < rays.size()) found_.resize(rays.size());
    const std::span found(found_.data(), rays.size());
    if (kind == approximate) return approximation->closest(rays, found);
    hits_.assign(rays.size(), Intersection{});
    scene.closest(rays, hits_, found);
}

} // namespace alhazen
