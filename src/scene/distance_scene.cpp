#include "scene/distance_scene.h"

#include <stdexcept>

#include "base/threads.h"

namespace alhazen {

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
                    "the scene has a shape that is no triangle mesh; accelerator \"sdf\" "
                    "knows triangles only");
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
    sample();
}

void DistanceScene::sample() {
    MeshDistance mesh(corners_);
    std::size_t total =
        static_cast<std::size_t>(n_.x) * static_cast<std::size_t>(n_.y) * static_cast<std::size_t>(n_.z);
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
            distances_[at] = static_cast<float>(found->distance / cell_);
            nearest_[at] = found->triangle;
            limit = (found->distance + cell_) * (1 + 1e-9);
        }
    });
}

std::size_t DistanceScene::nearest_sample(Vec3d q, double& away) const {
    Vec3i node;
    for (int i = 0; i < 3; ++i) node[i] = std::clamp(static_cast<int>(std::lround(q[i])), 0, n_[i] - 1);
    away = length(q - Vec3d(node));
    return index(node);
}

// To the triangle that is nearest to the nearest sample, which is mostly the nearest here, too.
double DistanceScene::distance_of_triangle(Vec3d q, std::size_t sample) const {
    const Corners& c = corners_[nearest_[sample]];
    Vec3d p = lo_ + q * cell_;
    return length(nearest_on_triangle(Vec3d(c.a), Vec3d(c.b), Vec3d(c.c), p).p - p) / cell_;
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

// Sphere tracing. No surface is nearer than the nearest sample says, less the way to it; where that is
// little, its triangle is asked, until it is nearer than a fifth of a cell. The distance must be falling: a
// ray that leaves a surface is near it, too.
std::optional<double> DistanceScene::march(const Ray& ray, double end) const {
    double speed = length(Vec3d(ray.d));
    if (corners_.empty() || !is_finite(ray.o) || !is_finite(ray.d) || !(speed > 0)) return std::nullopt;
    Vec3d o = (Vec3d(ray.o) - lo_) * (1 / cell_), d = Vec3d(ray.d) * (1 / speed);
    double s = 0, last = std::min(end * speed / cell_, 1e9);
    for (int i = 0; i < 3; ++i) {
        if (d[i] == 0) {
            if (o[i] < 0 || o[i] > n_[i] - 1) return std::nullopt;
            continue;
        }
        double a = -o[i] / d[i], b = (n_[i] - 1 - o[i]) / d[i];
        s = std::max(s, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    constexpr double near = 0.2, least_step = 0.15, next_to = 0.5;
    double before = static_cast<double>(infinity), away = 0;
    if (s == 0) { // on a surface, mostly
        s = 0.25;
        std::size_t sample = nearest_sample(o + d * s, away);
        before = distance_of_triangle(o + d * s, sample);
    }
    while (s < last) {
        Vec3d q = o + d * s;
        std::size_t sample = nearest_sample(q, away);
        double step = static_cast<double>(distances_[sample]) - away;
        if (step < next_to) {
            double here = distance_of_triangle(q, sample);
            if (here < near && here < before - 1e-6) return s * cell_ / speed;
            before = here;
            // Between what is sure and what is likely.
            step = std::max(0.5 * (std::max(step, 0.0) + here), least_step);
        } else {
            before = static_cast<double>(infinity);
        }
        s += step;
    }
    return std::nullopt;
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
