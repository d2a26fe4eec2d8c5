#include "scene/distance_scene.h"

#include <stdexcept>

#include "base/threads.h"

namespace alhazen {

namespace {

constexpr float distance_steps = 8; ///< that a cell is divided into

} // namespace

struct DistanceScene::Collector {
    DistanceScene& scene;

    void add(const Object& object, const Matrix4& world_from_object, const Found& way) {
        auto placed = static_cast<std::uint32_t>(scene.placed_.size());
        scene.placed_.push_back(way);
        scene.placed_.back().object = &object;
        std::uint32_t number = 0;
        for (const PlacedShape& shape : object.shapes()) {
            std::uint32_t count = shape.shape->primitive_count();
            const TriangleMesh* mesh = shape.shape->triangles();
            if (!mesh)
                throw std::runtime_error(
                    "the scene has a shape that is no triangle mesh; accelerator \"sdf\" knows triangles "
                    "only: take another accelerator, or leave out all shapes but meshes");
            bool is_border = shape.material && shape.material->is_interface();
            for (std::uint32_t i = 0; i < count && !is_border; ++i) {
                auto [a, b, c] = mesh->vertices(i);
                auto moved = [&](Vec3 p) { return Vec3(world_from_object.point(Vec3d(p))); };
                scene.corners_.push_back({moved(a), moved(b), moved(c)});
                scene.origins_.push_back({placed, number + i});
            }
            number += count;
        }
        for (const PlacedObject& instance : object.instances()) {
            Found inner = way;
            inner.instances[inner.depth++] = &instance;
            add(*instance.object, world_from_object * instance.world_from_object.matrix(), inner);
        }
    }
};

DistanceScene::DistanceScene(const Object& root, int cells) {
    Collector{*this}.add(root, Matrix4{}, Found{});
    // What MeshDistance would leave out, so that numbers stay the same.
    std::size_t kept = 0;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
        const Corners& t = corners_[i];
        if (!is_finite(t.a) || !is_finite(t.b) || !is_finite(t.c)) continue;
        corners_[kept] = t;
        origins_[kept++] = origins_[i];
    }
    corners_.resize(kept);
    origins_.resize(kept);
    if (corners_.empty()) return;
    Bounds3 box;
    for (const Corners& t : corners_)
        for (Vec3 p : {t.a, t.b, t.c}) box.extend(p);
    Vec3d size(box.diagonal());
    cell_ = max_component(size) / cells;
    if (!(cell_ > 0)) throw std::runtime_error("the scene has no extent");
    constexpr int margin = 2;
    for (int i = 0; i < 3; ++i) n_[i] = static_cast<int>(std::ceil(size[i] / cell_)) + 2 * margin + 1;
    lo_ = Vec3d(box.lo) - Vec3d(margin * cell_);
    for (int i = 0; i < 3; ++i) cubes_[i] = (n_[i] + 3) / 4;
    for (const Corners& t : corners_) planes_.push_back(plane_of(t));
    sample();
}

void DistanceScene::sample() {
    MeshDistance mesh(corners_);
    const std::size_t total = index(n_ - Vec3i{1, 1, 1}) / 64 * 64 + 64;
    distances_.resize(total);
    nearest_.resize(total);
    std::size_t rows = static_cast<std::size_t>(n_.y) * static_cast<std::size_t>(n_.z);
    parallel_for(rows, 16, [&](std::size_t row) {
        int y = static_cast<int>(row % static_cast<std::size_t>(n_.y));
        int z = static_cast<int>(row / static_cast<std::size_t>(n_.y));
        // Along a row the distance changes by a cell at most.
        double limit = static_cast<double>(infinity);
        for (int x = 0; x < n_.x; ++x) {
            Vec3d p = lo_ + Vec3d(Vec3i{x, y, z}) * cell_;
            auto found = mesh.nearest(p, limit);
            std::size_t at = index({x, y, z});
            distances_[at] =
                static_cast<std::uint8_t>(std::min(found->distance / cell_ * distance_steps, 255.0));
            nearest_[at] = found->triangle;
            limit = (found->distance + cell_) * (1 + 1e-9);
        }
    });
}

DistanceScene::Plane DistanceScene::plane_of(const Corners& t) const {
    auto in_cells = [&](Vec3 p) { return (Vec3d(p) - lo_) * (1 / cell_); };
    const Vec3d a = in_cells(t.a), ab = in_cells(t.b) - a, ac = in_cells(t.c) - a, n = cross(ab, ac);
    const double size = length(n);
    Plane plane;
    // A triangle much smaller than a cell stands for its neighbours, too, of which the grid does not know.
    const double extent = std::sqrt(std::max(length_squared(ab), length_squared(ac)));
    plane.slack = static_cast<float>(std::clamp(1 - extent, 0.25, 0.5));
    if (!(size > 0)) return plane;
    plane.n = Vec3(n * (1 / size));
    plane.c = static_cast<float>(dot(n, a) / size);
    return plane;
}

float DistanceScene::distance_to(std::uint32_t triangle, Vec3 q) const {
    const Corners& c = corners_[triangle];
    const Vec3d p = lo_ + Vec3d(q) * cell_;
    return static_cast<float>(length(nearest_on_triangle(Vec3d(c.a), Vec3d(c.b), Vec3d(c.c), p).p - p) /
                              cell_);
}

DistanceScene::Near DistanceScene::nearest_to(Vec3d p) const {
    Vec3d q = (p - lo_) * (1 / cell_);
    Near best;
    std::array<std::uint32_t, 8> asked{};
    std::size_t count = 0;
    for (int i = 0; i < 8; ++i) {
        Vec3i corner;
        for (int k = 0; k < 3; ++k)
            corner[k] = std::clamp(static_cast<int>(std::floor(q[k])) + (i >> k & 1), 0, n_[k] - 1);
        std::uint32_t candidate = nearest_[index(corner)];
        if (std::find(asked.begin(), asked.begin() + count, candidate) != asked.begin() + count) continue;
        asked[count++] = candidate;
        const Corners& c = corners_[candidate];
        TrianglePoint at = nearest_on_triangle(Vec3d(c.a), Vec3d(c.b), Vec3d(c.c), p);
        double distance2 = length_squared(at.p - p);
        if (distance2 < best.distance2) best = {distance2, candidate, at};
    }
    return best;
}

// Not finite, or far away, where the line stays beside the plane.
float DistanceScene::crossing(std::uint32_t triangle, const Stretch& stretch) const {
    const Plane& plane = planes_[triangle];
    return (plane.c - dot(plane.n, stretch.q)) / dot(plane.n, stretch.d);
}

std::optional<float> DistanceScene::meets(std::uint32_t triangle, const Stretch& stretch) const {
    const float at = crossing(triangle, stretch);
    if (!is_within(at, stretch)) return std::nullopt;
    if (!(distance_to(triangle, stretch.q + stretch.d * at) < planes_[triangle].slack)) return std::nullopt;
    return at;
}

std::optional<float> DistanceScene::meets_around(const Stretch& stretch) const {
    std::optional<float> first;
    std::uint32_t asked = 0;
    for (int i = 0; i < 8; ++i) {
        Vec3i corner;
        for (int k = 0; k < 3; ++k)
            corner[k] = std::clamp(static_cast<int>(stretch.q[k]) + (i >> k & 1), 0, n_[k] - 1);
        const std::uint32_t triangle = nearest_[index(corner)];
        if (i > 0 && triangle == asked) continue;
        asked = triangle;
        const auto met = meets(triangle, stretch);
        if (met && (!first || *met < *first)) first = met;
    }
    return first;
}

// Sphere tracing. No surface is nearer than the nearest sample says, less the way to it; where that is
// little, its triangle is asked. What the ray comes closer to, within a cell, is met where the ray passes its
// plane; what it has passed, or leaves, is not met any more.
std::optional<float> DistanceScene::march(Vec3 o, Vec3 d, float s, float end) const {
    constexpr float least_step = 0.15f, next_to = 0.5f, most_ahead = 1, low = 0.25f, from_start = 1;
    constexpr std::uint32_t none = 0xffffffffu;
    constexpr float relaxation = 1.4f;
    float before = 0, stretched = 0, last_step = 0;
    std::uint32_t passed = none;
    const Vec3i last = n_ - Vec3i{1, 1, 1};
    auto nearest = [](float x, int most) { return std::clamp(floor_to_int(x + 0.5f), 0, most); };
    while (s < end) {
        const Vec3 q = o + d * s;
        const Vec3i node{nearest(q.x, last.x), nearest(q.y, last.y), nearest(q.z, last.z)};
        const std::size_t sample = index(node);
        const float sure =
            static_cast<float>(distances_[sample]) * (1 / distance_steps) - length(q - Vec3(node));
        // The balls around this point and the one before must overlap, or something may be between.
        if (stretched > 0 && before + sure < stretched) {
            s -= stretched - before;
            stretched = 0;
            continue;
        }
        stretched = 0;
        if (sure >= next_to) {
            before = sure;
            // At the end nothing would ask whether it was too far.
            if (s + relaxation * sure < end) stretched = relaxation * sure;
            s += std::max(stretched, sure);
            continue;
        }
        const std::uint32_t triangle = nearest_[sample];
        const Plane& plane = planes_[triangle];
        const float height = dot(plane.n, q) - plane.c;
        // Also a little way back, as the last step may have been too long; but not to where the ray started.
        const Stretch stretch{q, d, std::max(-last_step, std::min(from_start - s, 0.0f)), most_ahead};
        if (triangle != passed && is_within(crossing(triangle, stretch), stretch)) {
            auto met = meets(triangle, stretch);
            // Near edges it is another one, of those around.
            if (!met) met = meets_around(stretch);
            if (met && s + *met >= end) return std::nullopt;
            if (met) return s + *met;
            passed = triangle;
        }
        const float here = std::abs(height) < low ? distance_to(triangle, q) : std::abs(height);
        // Between what is sure and what is likely.
        last_step = std::max(0.25f * std::max(sure, 0.0f) + 0.75f * here, least_step);
        s += last_step;
    }
    return std::nullopt;
}

std::optional<double> DistanceScene::march(const Ray& ray, double end) const {
    const double speed = length(Vec3d(ray.d));
    if (corners_.empty() || !is_finite(ray.o) || !is_finite(ray.d) || !(speed > 0)) return std::nullopt;
    const Vec3d o = (Vec3d(ray.o) - lo_) * (1 / cell_), d = Vec3d(ray.d) * (1 / speed);
    double s = 0, last = std::min(end * speed / cell_, 1e9);
    for (int i = 0; i < 3; ++i) {
        if (d[i] == 0) {
            if (o[i] < 0 || o[i] > n_[i] - 1) return std::nullopt;
            continue;
        }
        const double a = -o[i] / d[i], b = (n_[i] - 1 - o[i]) / d[i];
        s = std::max(s, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    if (s == 0) s = 0.25; // it starts on a surface, mostly
    // From there on single precision is plenty.
    const auto met = march(Vec3(o + d * s), Vec3(d), 0, static_cast<float>(last - s));
    if (!met) return std::nullopt;
    return (s + static_cast<double>(*met)) * cell_ / speed;
}

Found DistanceScene::found_at(const Ray& ray, double t) const {
    Near near = nearest_to(Vec3d(ray.o) + Vec3d(ray.d) * t);
    const Origin& origin = origins_[near.triangle];
    Found found = placed_[origin.placed];
    found.hit.t = static_cast<float>(t);
    found.hit.u = static_cast<float>(near.at.b);
    found.hit.v = static_cast<float>(near.at.c);
    found.hit.primitive = origin.primitive;
    found.ray = ray;
    for (std::size_t i = 0; i < found.depth; ++i)
        found.ray = found.instances[i]->object_from_world.ray(found.ray);
    return found;
}

std::optional<Hit> DistanceScene::closest(const Ray& ray) const {
    auto t = march(ray, static_cast<double>(ray.tmax));
    if (!t) return std::nullopt;
    return Object::surface(found_at(ray, *t));
}

bool DistanceScene::visible(const Ray& ray) const {
    // What the ray goes to is a surface, too, and is not to be met.
    constexpr double free_cells = 2;
    double speed = static_cast<double>(length(ray.d));
    double end = static_cast<double>(ray.tmax);
    if (std::isfinite(ray.tmax)) end -= free_cells * cell_ / speed;
    return !march(ray, end);
}

} // namespace alhazen
