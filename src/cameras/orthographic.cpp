/// The orthographic camera: all rays parallel, so that size does not change with distance. A lens, as pbrt-v4
/// has it, is one thin lens around the camera's axis: a ray leaves a point of the lens towards the place
/// where the parallel ray meets the plane at the focal distance. That plane is sharp and keeps its scale;
/// before and behind it the picture is in perspective, however small the lens, since all light goes through
/// it.
#include "cameras/screen.h"

namespace alhazen {

namespace {

class OrthographicCamera final : public FlatCamera {
  public:
    static void describe(Fields<OrthographicCamera>& f) {
        f.about(
            "Parallel rays, as in technical drawings: distant things keep their size. With a lens, that "
            "holds in the plane of focus only, since all rays then pass through the lens, as in pbrt-v4.");
        describe_flat(f);
        describe_common(f);
        f.example("small", {make_array("screenwindow", ValueType::real, std::vector<float>{-2, 2, -1, 1})});
    }
    void finish(const Node& node, BuildContext& context) {
        if (finish_flat(node, context))
            set_ray_plane(lensradius > 0 ? static_cast<double>(focaldistance) : 0, 1);
    }

    std::optional<CameraRay> ray(const CameraSample& sample) const override {
        Vec2d s = screen(sample.film);
        float time = ray_time(sample.time);
        if (lensradius == 0) return make_ray({s.x, s.y, 0}, {0, 0, 1}, time);
        Vec2d on_lens = lens(sample.lens);
        return make_ray({on_lens.x, on_lens.y, 0},
                        {s.x - on_lens.x, s.y - on_lens.y, static_cast<double>(focaldistance)}, time);
    }

    std::optional<Projection> projection() const override {
        if (lensradius > 0) return std::nullopt;
        return projection_of(1, false);
    }
};

} // namespace

Kind<Camera> orthographic_camera() {
    return make_kind<Camera, OrthographicCamera>("orthographic");
}

} // namespace alhazen
