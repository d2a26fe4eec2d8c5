/// The perspective camera: a pinhole, or a thin lens that is sharp at one distance (Pharr et al. 2023,
/// section 5.2). Rays leave the origin through a window in the plane z = 1.
#include "cameras/screen.h"

namespace alhazen {

namespace {

class PerspectiveCamera final : public FlatCamera {
  public:
    float fov = 90;
    std::optional<float> halffov;

    static void describe(Fields<PerspectiveCamera>& f) {
        f.about("What an eye or an ordinary camera sees: distant things are smaller.");
        f.field("fov", &PerspectiveCamera::fov, "angle that the picture's shorter side covers")
            .in(0, 180)
            .above(0)
            .unit("degrees");
        f.field("halffov", &PerspectiveCamera::halffov, "half of that angle, instead of fov")
            .in(0, 90)
            .above(0)
            .unit("degrees");
        describe_flat(f);
        describe_common(f);
        f.example("portrait",
                  {make_float("fov", 30), make_float("lensradius", .05f), make_float("focaldistance", 3)});
    }
    void finish(const Node& node, BuildContext& context) {
        if (!finish_flat(node, context)) return;
        const double angle = halffov ? 2 * static_cast<double>(*halffov) : static_cast<double>(fov);
        if (angle >= 180) {
            std::string_view given = halffov ? "halffov" : "fov";
            context.messages.add_error(node.place_of(given),
                                       "parameter \"" + std::string(given) + "\" is " +
                                           number_text(halffov ? 90 : 180) +
                                           "; it must be less, since a flat picture cannot show half of all "
                                           "directions");
            return;
        }
        half_size_ = std::tan(angle / 2 * (3.14159265358979323846 / 180));
        const double plane = lensradius > 0 ? static_cast<double>(focaldistance) : 1;
        set_ray_plane(plane, plane * half_size_);
    }

    std::optional<CameraRay> ray(const CameraSample& sample) const override {
        Vec2d s = screen(sample.film) * half_size_;
        Vec3d through(s.x, s.y, 1);
        float time = ray_time(sample.time);
        if (lensradius == 0) return make_ray(through, time);
        Vec2d on_lens = lens(sample.lens);
        Vec3d from(on_lens.x, on_lens.y, 0);
        return make_ray(from, through * static_cast<double>(focaldistance) - from, time);
    }

    std::optional<Projection> projection() const override {
        if (lensradius > 0) return std::nullopt;
        return projection_of(half_size_, true);
    }

  private:
    double half_size_ = 1; ///< half of the shorter side of the window at z = 1
};

} // namespace

Kind<Camera> perspective_camera() {
    return make_kind<Camera, PerspectiveCamera>("perspective");
}

} // namespace alhazen
