/// The finished, immutable scene: what a ray meets, whether a point sees another, which light to sample.
#pragma once

#include <cassert>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/hit.h"
#include "lights/light_chooser.h"
#include "materials/material.h"
#include "media/clear_cells.h"
#include "scene/distance_scene.h"
#include "scene/object.h"

namespace alhazen {

/// What is in a scene, counted.
struct SceneCounts {
    std::size_t shapes = 0, primitives = 0, triangles = 0, instances = 0, objects = 0;
    std::size_t accel_bytes = 0, accel_nodes = 0, shape_bytes = 0;
};

class Scene {
  public:
    /// root is the last object of the list; it holds what is in the scene itself. Lights must outlive the
    /// scene's parts that refer to them, so the scene owns both.
    Scene(std::vector<std::unique_ptr<Object>> objects, std::vector<std::unique_ptr<Light>> lights);
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    /// The nearest hit at 0 < t < ray.tmax. Alpha cutouts are seen through.
    std::optional<Hit> closest(const Ray& ray) const;
    /// True when nothing stands at 0 < t < ray.tmax. Alpha cutouts and surfaces that are only borders between
    /// media do not count.
    bool visible(const Ray& ray) const;

    /// The same for many rays at once; hits as constructed. found[i].object is nullptr where nothing is hit.
    void closest(std::span<const Ray> rays, std::span<Intersection> hits, std::span<Found> found) const;
    /// blocked: 1 where something stands at 0 < t < ray.tmax, else 0.
    void blocked(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const;
    /// The full hit of what closest has found.
    static std::optional<Hit> surface(const Found& found);

    std::span<const Light* const> lights() const { return lights_; }
    std::span<const Light* const> infinite_lights() const { return infinite_; }
    /// Must be called before choose_light: name is one of light_chooser_names().
    void set_light_chooser(std::string_view name);
    std::optional<ChosenLight> choose_light(const LightReceiver& at, float u) const {
        return chooser_->choose(at, u);
    }
    float light_probability(const LightReceiver& at, const Light* light) const {
        return chooser_->probability(at, light);
    }

    /// From now on all rays but those from the camera are answered by a global distance field of so many
    /// cells along the scene's longest side. Throws std::runtime_error as DistanceScene does.
    void approximate(int cells) { approximation_ = std::make_unique<DistanceScene>(*root_, cells); }
    /// nullptr when every ray is traced exactly.
    const DistanceScene* approximation() const { return approximation_.get(); }

    /// Whether anything in it does, so that hits depend on rays' times.
    bool moves() const { return moves_; }
    /// What is in the scene itself, instances among it.
    const Object& root() const { return *root_; }
    /// Builds another structure for each object; for measurements. Nobody may be asking meanwhile.
    void rebuild(const AccelChoice& accel);

    /// What the camera stands in; nullptr for nothing.
    const Medium* medium_at_camera() const { return medium_at_camera_; }
    void set_medium_at_camera(const Medium* medium);
    /// Where light in a medium, which must be one of the scene's, meets no surface.
    const ClearCells& clear_cells(const Medium& medium) const {
        const ClearCells* cells = find_cells(medium);
        assert(cells);
        return *cells;
    }
    /// What textures blur over where the camera looks at them; empty: nothing.
    const PixelCone* pixel_cone() const { return pixel_cone_ ? &*pixel_cone_ : nullptr; }
    void set_pixel_cone(const PixelCone& cone) { pixel_cone_ = cone; }
    /// Whether light may pass through any medium.
    bool has_media() const { return has_media_; }

    const Bounds3& bounds() const { return bounds_; }
    SceneCounts counts() const;

  private:
    const ClearCells* find_cells(const Medium& medium) const {
        for (const ClearCells& cells : clear_cells_)
            if (&cells.medium() == &medium) return &cells;
        return nullptr;
    }
    void add_medium(const Medium* medium);

    std::vector<std::unique_ptr<Light>> owned_lights_;
    std::vector<std::unique_ptr<Object>> objects_;
    const Object* root_;
    std::vector<const Light*> lights_, infinite_;
    std::unique_ptr<LightChooser> chooser_;
    std::unique_ptr<DistanceScene> approximation_;
    Bounds3 bounds_;
    const Medium* medium_at_camera_ = nullptr;
    std::vector<ClearCells> clear_cells_; ///< one a medium
    std::optional<PixelCone> pixel_cone_;
    bool has_media_ = false;
    bool moves_ = false;
};

} // namespace alhazen
