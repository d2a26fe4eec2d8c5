#include "scene/scene.h"

namespace alhazen {

Scene::Scene(std::vector<std::unique_ptr<Object>> objects, std::vector<std::unique_ptr<Light>> lights)
    : owned_lights_(std::move(lights)), objects_(std::move(objects)), root_(objects_.back().get()),
      bounds_(root_->bounds()), moves_(root_->moves()) {
    for (const auto& light : owned_lights_) {
        light->prepare(bounds_);
        lights_.push_back(light.get());
        if (light->is_infinite() && !light->is_delta()) infinite_.push_back(light.get());
    }
    for (const auto& object : objects_)
        for (const PlacedShape& placed : object->shapes()) {
            has_media_ = has_media_ || placed.media.is_border();
            add_medium(placed.media.inside);
            add_medium(placed.media.outside);
        }
    set_light_chooser("bvh");
}

void Scene::set_medium_at_camera(const Medium* medium) {
    medium_at_camera_ = medium;
    has_media_ = has_media_ || medium;
    add_medium(medium);
}

// nullptr is nothing.
void Scene::add_medium(const Medium* medium) {
    if (!medium || find_cells(*medium)) return;
    ClearCells& cells = clear_cells_.emplace_back(*medium);
    if (medium->majorants().is_everywhere()) return;
    for (std::uint32_t i = 0; i < root_->count(); ++i) cells.add_surface(root_->box(i));
}

void Scene::set_light_chooser(std::string_view name) {
    chooser_ = make_light_chooser(name, lights_);
}

// In any order: the objects' own boxes stay as they are.
void Scene::rebuild(const AccelChoice& accel) {
    for (auto& object : objects_) object->rebuild(accel);
}

std::optional<Hit> Scene::closest(const Ray& ray) const {
    Found found;
    root_->closest(ray, found);
    return surface(found);
}

std::optional<Hit> Scene::surface(const Found& found) {
    if (!found.object) return std::nullopt;
    return Object::surface(found);
}

void Scene::closest(std::span<const Ray> rays, std::span<Intersection> hits, std::span<Found> found) const {
    root_->closest(rays, hits, found);
}

void Scene::blocked(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const {
    root_->any(rays, blocked);
}

bool Scene::visible(const Ray& ray) const {
    return !root_->any(ray);
}

SceneCounts Scene::counts() const {
    SceneCounts counts;
    counts.objects = objects_.size() - 1;
    for (const auto& object : objects_) {
        counts.shapes += object->shapes().size();
        counts.instances += object->instances().size();
        LayoutStats stats = object->structure().stats();
        counts.accel_bytes += stats.bytes;
        counts.accel_nodes += stats.nodes;
        for (const PlacedShape& placed : object->shapes()) {
            counts.shape_bytes += sizeof placed + placed.shape->bytes();
            counts.primitives += placed.shape->primitive_count();
            if (placed.shape->triangles()) counts.triangles += placed.shape->primitive_count();
        }
    }
    return counts;
}

} // namespace alhazen
