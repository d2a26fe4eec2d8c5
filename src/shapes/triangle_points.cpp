#include "shapes/triangle_points.h"

#include <algorithm>

namespace alhazen {

TrianglePoints::TrianglePoints(std::vector<std::array<Vec3d, 3>> triangles,
                               const std::function<Vec3d(Vec3d)>& to_world)
    : triangles_(std::move(triangles)) {
    up_to_.reserve(triangles_.size());
    for (const auto& t : triangles_) {
        Vec3d a = to_world(t[0]), b = to_world(t[1]), c = to_world(t[2]);
        area_ += 0.5 * length(cross(b - a, c - a));
        up_to_.push_back(area_);
    }
}

std::optional<Vec3d> TrianglePoints::at(Vec2 u) const {
    if (!(area_ > 0)) return std::nullopt;
    double pick = static_cast<double>(u.x) * area_;
    auto at = std::upper_bound(up_to_.begin(), up_to_.end(), pick);
    if (at == up_to_.end()) --at;
    auto k = static_cast<std::size_t>(at - up_to_.begin());
    // What is left of u.x after the choice is uniform again.
    double below = k > 0 ? up_to_[k - 1] : 0, width = up_to_[k] - below;
    double x = std::clamp(width > 0 ? (pick - below) / width : 0.0, 0.0, 1.0);
    double root = std::sqrt(x), y = static_cast<double>(u.y);
    const auto& t = triangles_[k];
    return t[0] * (1 - root) + t[1] * (root * (1 - y)) + t[2] * (root * y);
}

} // namespace alhazen
