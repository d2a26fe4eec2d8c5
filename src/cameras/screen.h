/// The rectangle that flat cameras look through, and what they share: shutter, lens, errors.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "cameras/camera.h"
#include "math/warp.h"

namespace alhazen {

/// Swaps a shutter that closes before it opens, with a warning.
void check_shutter(Camera& camera, const Node& node, BuildContext& context);

/// A camera that looks through a window in the plane z = 1 (perspective) or from a window in the plane z = 0
/// (orthographic) of camera space: x to the right, y up, z ahead, left-handed. The film's top left corner is
/// the window's left end and upper end.
struct FlatCamera : Camera {
    std::optional<float> frameaspectratio;
    std::vector<float> screenwindow;
    float lensradius = 0;
    float focaldistance = 1e6f;

    bool has_lens() const final { return lensradius > 0; }
    bool receives_light() const final { return plane_scale_ > 0; }
    std::optional<CameraConnection> sample_towards(Vec3 p, Vec2 u, float time) const final;
    float ray_density(const Ray& ray, float t) const final;

  protected:
    template <class T>
    static void describe_flat(Fields<T>& f) {
        f.field("frameaspectratio", &T::frameaspectratio, "the picture's width divided by its height")
            .above(0)
            .otherwise("that of the resolution");
        f.field("screenwindow", &T::screenwindow, "what is seen on the screen: x from, x to, y from, y to")
            .otherwise("-1 to 1 along the shorter side");
        f.field("lensradius", &T::lensradius, "of the thin lens; 0 for a pinhole, all sharp")
            .at_least(0)
            .unit("camera space");
        f.field("focaldistance", &T::focaldistance, "of the plane that is sharp")
            .above(0)
            .unit("camera space");
    }
    /// Checks what the fields share and works out the screen; true when there was no error.
    bool finish_flat(const Node& node, BuildContext& context);
    /// The place on the screen of a place on the film.
    Vec2d screen(Vec2 film) const {
        return {corner_.x + static_cast<double>(film.x) * step_.x,
                corner_.y + static_cast<double>(film.y) * step_.y};
    }
    /// A place on the lens.
    Vec2d lens(Vec2 u) const { return Vec2d(sample_disk(u)) * static_cast<double>(lensradius); }
    /// Says where rays go, so that light can come back: from one place on the lens they are spread evenly
    /// over a window in the plane at the distance z, whose size is the screen's times scale. z = 0: they are
    /// parallel, and there is no lens.
    void set_ray_plane(double z, double scale) {
        plane_z_ = z;
        plane_scale_ = scale;
    }
    /// The map of a camera without lens whose window is scaled by half_size, in camera space.
    Projection projection_of(double half_size, bool is_perspective) const;
    float ray_time(float u) const { return lerp(u, shutteropen, shutterclose); }
    CameraRay make_ray(Vec3d origin, Vec3d direction, float time) const;
    /// From the camera's own origin.
    CameraRay make_ray(Vec3d direction, float time) const { return make_ray_from(eye_, direction, time); }

    Transform world_from_camera_;

  private:
    CameraRay make_ray_from(Vec3 origin, Vec3d direction, float time) const {
        return {{origin, Vec3(normalize(world_from_camera_.vector(direction))), infinity, time}, 1};
    }
    /// What Camera::ray_density() is for a vector of camera space, at a distance in the world.
    float density(Vec3d v, double distance) const;

    Vec3 eye_;
    Vec2d corner_, step_, resolution_{1, 1};
    double plane_z_ = 0, plane_scale_ = 0;
};

} // namespace alhazen
