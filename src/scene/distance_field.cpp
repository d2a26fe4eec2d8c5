#include "scene/distance_field.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/threads.h"

namespace alhazen {

namespace {

/// From a brick's middle to its farthest sample, cells.
const float brick_radius = 1.5f * std::sqrt(3.0f);
/// Bricks whose middle is so many cells from everything are far.
const float far_away = march_near + brick_radius;

// limit is how far it is at most, if nothing was lost by rounding.
MeshDistance::Nearest nearest(const MeshDistance& mesh, Vec3d p, double limit) {
    if (auto found = mesh.nearest(p, limit)) return *found;
    return mesh.nearest(p, static_cast<double>(infinity)).value();
}

std::uint32_t eighths(double distance) {
    return static_cast<std::uint32_t>(distance * static_cast<double>(march_steps_a_cell));
}

// v in -1 .. 1, in steps.
std::uint32_t quantised(double v) {
    return static_cast<std::uint32_t>(std::lround((std::clamp(v, -1.0, 1.0) + 1) * (0.5 * march_steps)));
}

double unquantised(std::uint32_t steps) {
    return steps * (2.0 / march_steps) - 1;
}

// See MarchSample. to: from the sample to a point of the plane, in cells.
MarchSample bits_of_plane(Vec3d n, Vec3d to) {
    n = n * (1 / (std::abs(n.x) + std::abs(n.y) + std::abs(n.z)));
    Vec2d at{n.x, n.y};
    if (n.z < 0) at = {std::copysign(1 - std::abs(n.y), n.x), std::copysign(1 - std::abs(n.x), n.y)};
    const std::uint32_t x = quantised(at.x), y = quantised(at.y);
    // The height is that along the normal which these will give.
    at = {unquantised(x), unquantised(y)};
    const double z = 1 - std::abs(at.x) - std::abs(at.y), folded = std::max(-z, 0.0);
    const Vec3d given{at.x - std::copysign(folded, at.x), at.y - std::copysign(folded, at.y), z};
    const double height = dot(given, to) / static_cast<double>(march_most_height);
    return x << march_normal_x | y << march_normal_y | quantised(height) << march_height;
}

} // namespace

DistanceField::DistanceField(const std::vector<Corners>& triangles, int cells) {
    Bounds3 box;
    for (const Corners& t : triangles)
        for (Vec3 p : {t.a, t.b, t.c}) box.extend(p);
    const Vec3d size = Vec3d(box.hi) - Vec3d(box.lo);
    // Of single precision, so that rays, which are, lose nothing on the way into the field.
    cell_ = static_cast<double>(static_cast<float>(max_component(size) / cells));
    if (!(cell_ > 0)) throw std::runtime_error("the scene has no extent");
    constexpr int margin = 2;
    for (int i = 0; i < 3; ++i) {
        n_[i] = static_cast<int>(std::ceil(size[i] / cell_)) + 2 * margin + 1;
        bricks_along_[i] = (n_[i] + side - 1) / side;
    }
    lo_ = Vec3d(Vec3(Vec3d(box.lo) - Vec3d(margin * cell_)));
    if (!is_finite(lo_)) throw std::runtime_error("the scene is too large");

    const MeshDistance mesh(triangles, MeshDistance::Asked::nearest);
    const std::vector<float> distances = measure_bricks(mesh);
    bricks_.resize(distances.size());
    std::vector<std::size_t> near;
    for (std::size_t i = 0; i < distances.size(); ++i)
        if (distances[i] >= far_away) {
            bricks_[i] = march_is_far | eighths(static_cast<double>(distances[i]));
        } else {
            bricks_[i] = static_cast<std::uint32_t>(near.size());
            near.push_back(i);
        }
    samples_ = BigArray<MarchSample>(near.size() * brick_size);
    triangles_ = BigArray<std::uint32_t>(near.size() * brick_size);
    parallel_for(near.size(), 8, [&](std::size_t i) { fill(near[i], distances[near[i]], mesh, triangles); });
}

MarchField DistanceField::march_field() const {
    const Vec3 lo(lo_);
    return {bricks_.data(),
            samples_.data(),
            {n_.x - 1, n_.y - 1, n_.z - 1},
            bricks_along_.x,
            bricks_along_.x * bricks_along_.y,
            {lo.x, lo.y, lo.z},
            static_cast<float>(cell_)};
}

Vec3i DistanceField::first_sample(std::size_t brick) const {
    const auto i = static_cast<int>(brick);
    return Vec3i{i % bricks_along_.x, i / bricks_along_.x % bricks_along_.y,
                 i / bricks_along_.x / bricks_along_.y} *
           side;
}

// From their middles, in cells.
std::vector<float> DistanceField::measure_bricks(const MeshDistance& mesh) const {
    const auto rows = static_cast<std::size_t>(bricks_along_.y) * static_cast<std::size_t>(bricks_along_.z);
    const auto in_row = static_cast<std::size_t>(bricks_along_.x);
    std::vector<float> distances(rows * in_row);
    parallel_for(rows, 4, [&](std::size_t row) {
        double limit = static_cast<double>(infinity);
        for (std::size_t i = row * in_row; i < (row + 1) * in_row; ++i) {
            const Vec3d middle = place(first_sample(i)) + Vec3d(0.5 * (side - 1) * cell_);
            const double distance = nearest(mesh, middle, limit).distance;
            distances[i] = static_cast<float>(distance / cell_);
            limit = (distance + side * cell_) * (1 + 1e-9);
        }
    });
    return distances;
}

void DistanceField::fill(std::size_t brick, float distance, const MeshDistance& mesh,
                         const std::vector<Corners>& triangles) {
    const double limit = static_cast<double>(distance + brick_radius) * cell_ * (1 + 1e-6);
    const Vec3i first = first_sample(brick);
    for (int i = 0; i < static_cast<int>(brick_size); ++i) {
        const Vec3d p = place(first + Vec3i{i & 3, i >> 2 & 3, i >> 4});
        const MeshDistance::Nearest found = nearest(mesh, p, limit);
        const std::size_t at = bricks_[brick] * brick_size + static_cast<std::size_t>(i);
        samples_[at] = std::min(eighths(found.distance / cell_), march_steps);
        triangles_[at] = found.triangle;
        if (static_cast<float>(samples_[at]) >= march_near * march_steps_a_cell) continue;
        const Corners& t = triangles[found.triangle];
        const Vec3d to = (found.at.p - p) * (1 / cell_);
        Vec3d n = cross(Vec3d(t.b) - Vec3d(t.a), Vec3d(t.c) - Vec3d(t.a));
        if (!(length_squared(n) > 0)) n = to;
        if (!(length_squared(n) > 0)) n = {0, 0, 1};
        samples_[at] |= bits_of_plane(n, to);
    }
}

} // namespace alhazen
