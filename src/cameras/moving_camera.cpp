#include "cameras/moving_camera.h"

namespace alhazen {

namespace {

class MovingCamera final : public Camera {
  public:
    MovingCamera(std::unique_ptr<Camera> camera, const MovingTransform& world_from_camera)
        : camera_(std::move(camera)), world_from_camera_(world_from_camera) {
        shutteropen = camera_->shutteropen;
        shutterclose = camera_->shutterclose;
        name = camera_->name;
    }

    bool moves() const override { return true; }
    bool has_lens() const override { return camera_->has_lens(); }
    std::optional<CameraRay> ray(const CameraSample& sample) const override {
        auto found = camera_->ray(sample);
        if (!found) return std::nullopt;
        found->ray = world_from_camera_.at(found->ray.time).ray(found->ray);
        const float stretch = length(found->ray.d);
        found->ray.d = found->ray.d / stretch;
        found->ray.tmax *= stretch;
        return found;
    }
    /// Densities are then the same here and there.
    bool receives_light() const override {
        return camera_->receives_light() && world_from_camera_.is_rigid();
    }
    std::optional<CameraConnection> sample_towards(Vec3 p, Vec2 u, float time) const override {
        const Transform place = world_from_camera_.at(time);
        auto view = camera_->sample_towards(place.inverse_point(p), u, time);
        if (!view) return std::nullopt;
        view->p = place.point(view->p);
        view->d = normalize(place.vector(view->d));
        return view;
    }
    float ray_density(const Ray& ray, float t) const override {
        return camera_->ray_density(world_from_camera_.at(ray.time).inverse_ray(ray), t);
    }

  private:
    std::unique_ptr<Camera> camera_;
    MovingTransform world_from_camera_;
};

} // namespace

std::unique_ptr<Camera> make_moving_camera(std::unique_ptr<Camera> camera,
                                           const MovingTransform& world_from_camera) {
    return std::make_unique<MovingCamera>(std::move(camera), world_from_camera);
}

} // namespace alhazen
