#include "scene/distance_scene.h"

#include <algorithm>
#include <cstddef>
#include <stdexcept>

#include "scene/march/dispatch.h"

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

DistanceScene::DistanceScene(const Object& root, int cells) : kernel_(supported_march_kernels().front()) {
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
    if (!corners_.empty()) field_.emplace(corners_, cells);
}

template <class Take>
void DistanceScene::march(std::span<const Ray> rays, const Take& take) const {
    // What rays go to that end somewhere is a surface, too, and is not to be met.
    constexpr float free_cells = 0.75f;
    if (!field_) return;
    constexpr std::size_t most = 512;
    float t[most];
    std::uint32_t samples[most];
    static_assert(sizeof(Ray) == march_ray_size * sizeof(float) && offsetof(Ray, tmax) == 6 * sizeof(float));
    for (std::size_t first = 0; first < rays.size(); first += most) {
        const std::size_t count = std::min(rays.size() - first, most);
        kernel_->march(field_->march_field(),
                       {&rays[first].o.x, static_cast<std::uint32_t>(count), free_cells, t, samples});
        take(first, std::span(t, count), std::span(samples, count));
    }
}

void DistanceScene::closest(std::span<const Ray> rays, std::span<Found> found) const {
    for (Found& f : found) f.object = nullptr;
    march(rays, [&](std::size_t first, std::span<const float> t, std::span<std::uint32_t> samples) {
        // What each hit needs comes from memory while others are looked at.
        auto for_hits = [&](auto&& look) {
            for (std::size_t i = 0; i < t.size(); ++i)
                if (t[i] < infinity) look(i);
        };
        for_hits([&](std::size_t i) { field_->prefetch_triangle(samples[i]); });
        for_hits([&](std::size_t i) {
            samples[i] = field_->triangle(samples[i]);
            __builtin_prefetch(&corners_[samples[i]]);
            __builtin_prefetch(&origins_[samples[i]]);
        });
        for_hits([&](std::size_t i) { find(rays[first + i], t[i], samples[i], found[first + i]); });
    });
}

void DistanceScene::find(const Ray& ray, float t, std::uint32_t triangle, Found& found) const {
    const Corners& c = corners_[triangle];
    const TrianglePoint at = nearest_on_triangle(Vec3d(c.a), Vec3d(c.b), Vec3d(c.c), Vec3d(ray.at(t)));
    // Whoever goes on from what is met must get further: beside a triangle's end its nearest point may be
    // where the ray starts.
    constexpr double least_cells = 0.1;
    if (!(dot(at.p - Vec3d(ray.o), Vec3d(ray.d)) > least_cells * field_->cell() * length(Vec3d(ray.d))))
        return;
    const Origin& origin = origins_[triangle];
    found = placed_[origin.placed];
    found.hit.t = t;
    found.hit.u = static_cast<float>(at.b);
    found.hit.v = static_cast<float>(at.c);
    found.hit.primitive = origin.primitive;
    found.ray = ray;
    for (std::size_t i = 0; i < found.depth; ++i)
        found.ray = found.instances[i]->object_from_world.ray(found.ray);
}

void DistanceScene::blocked(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const {
    std::fill(blocked.begin(), blocked.end(), std::uint8_t{0});
    march(rays, [&](std::size_t first, std::span<const float> t, std::span<std::uint32_t>) {
        for (std::size_t i = 0; i < t.size(); ++i) blocked[first + i] = t[i] < infinity;
    });
}

std::optional<Hit> DistanceScene::closest(const Ray& ray) const {
    Found found;
    closest({&ray, 1}, {&found, 1});
    if (!found.object) return std::nullopt;
    return Object::surface(found);
}

bool DistanceScene::visible(const Ray& ray) const {
    std::uint8_t is_blocked = 0;
    blocked({&ray, 1}, {&is_blocked, 1});
    return !is_blocked;
}

} // namespace alhazen
