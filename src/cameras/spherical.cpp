/// The spherical camera: all directions around a point on one picture, as environment maps need them. The
/// picture is a world map (equirectangular) or an unfolded octahedron in which equal areas stay equal
/// (Clarberg 2008).
#include "cameras/screen.h"
#include "math/equal_area.h"

namespace alhazen {

enum class SphericalMapping { equalarea, equirectangular };
template <>
struct EnumNames<SphericalMapping> {
    static constexpr std::array names{"equalarea", "equirectangular"};
};

namespace {

class SphericalCamera final : public FlatCamera {
  public:
    SphericalMapping mapping = SphericalMapping::equalarea;

    static void describe(Fields<SphericalCamera>& f) {
        f.about("Every direction around a point. Window and lens are read, as scenes give them, but have no "
                "effect.");
        f.field("mapping", &SphericalCamera::mapping, "how the sphere lies on the picture");
        describe_flat(f);
        describe_common(f);
        f.example("world_map", {make_string("mapping", "equirectangular")});
    }
    void finish(const Node& node, BuildContext& context) {
        finish_flat(node, context);
        size_ = Vec2d(context.film_resolution);
    }

    std::optional<CameraRay> ray(const CameraSample& sample) const override {
        Vec2d uv(static_cast<double>(sample.film.x) / size_.x, static_cast<double>(sample.film.y) / size_.y);
        // The maps' poles are on their z axis, the camera's upward direction is y.
        Vec3d d = mapping == SphericalMapping::equalarea
                      ? Vec3d(equal_area_to_sphere(wrap_equal_area(Vec2(uv))))
                      : equirectangular(uv);
        return make_ray({0, 0, 0}, {d.x, d.z, d.y}, ray_time(sample.time));
    }

  private:
    // Longitude across, from +x over +z (which is +y here, before the axes change places); latitude down from
    // the pole.
    static Vec3d equirectangular(Vec2d uv) {
        constexpr double pi_d = 3.14159265358979323846;
        double theta = pi_d * uv.y, phi = 2 * pi_d * uv.x;
        return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    }
    Vec2d size_{1, 1};
};

} // namespace

Kind<Camera> spherical_camera() {
    return make_kind<Camera, SphericalCamera>("spherical");
}

} // namespace alhazen
