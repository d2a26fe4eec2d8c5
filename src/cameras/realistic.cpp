/// The realistic camera: rays from the film through the glass of a photographic lens, with its depth of
/// field, distortion, vignetting and aberrations (Kolb, Mitchell and Hanrahan 1995; weights as in pbrt-v4).
#include <numbers>

#include <fmt/format.h>

#include "base/file.h"
#include "cameras/aperture_mask.h"
#include "cameras/lens_system.h"
#include "cameras/screen.h"
#include "image/codec.h"

namespace alhazen {

namespace {

class RealisticCamera final : public Camera {
  public:
    std::string lensfile;
    std::optional<float> aperturediameter;
    float focusdistance = 10;
    std::string aperture = "circular";

    static void describe(Fields<RealisticCamera>& f) {
        f.about(
            "A photographic lens, from the table of its glasses: rays are refracted at each surface. A unit "
            "of "
            "camera space is a metre; the film's size is its \"diagonal\". The picture shows the light that "
            "reaches the film, which falls with the square of the f-number; the film's \"iso\" and the "
            "exposure "
            "time make up for it. Light cannot be brought back through the lens: \"bdpt\", \"mlt\" and "
            "\"lightpath\" do not work with it.");
        f.field("lensfile", &RealisticCamera::lensfile,
                "the lens, relative to the scene's folder: a row for each surface from the scene's side, "
                "with the "
                "radius of curvature (positive when its centre lies on the film's side, 0 for the aperture "
                "stop), the "
                "distance to the next surface, the refractive index in between, and the diameter of the "
                "opening, in mm; "
                "# begins a comment")
            .required();
        f.field("aperturediameter", &RealisticCamera::aperturediameter,
                "of the aperture stop's opening, which the lens file's is the largest of")
            .above(0)
            .otherwise("1")
            .unit("mm");
        f.field("focusdistance", &RealisticCamera::focusdistance, "from the film to what is sharp")
            .above(0)
            .unit("metres");
        f.field("aperture", &RealisticCamera::aperture,
                "the shape of the stop's opening: circular, gaussian, square, pentagon, star, or an image "
                "whose grey "
                "values say how much passes");
        describe_common(f);
        f.example("double_gauss", {make_string("lensfile", "lenses/double-gauss-50mm.txt"),
                                   make_float("aperturediameter", 10), make_float("focusdistance", 2)});
    }

    void finish(const Node& node, BuildContext& context) {
        check_shutter(*this, node, context);
        world_from_camera_ = context.world_from_node;
        resolution_ = Vec2d(context.film_resolution);
        const double diagonal = static_cast<double>(context.film_diagonal);
        film_size_ = resolution_ * (diagonal / length(resolution_));
        if (!read_lens(node, context) || !read_aperture(node, context)) return;
        const std::string problem = lens_.focus(static_cast<double>(focusdistance));
        if (!problem.empty()) {
            const bool is_distance = lens_.thick_lens().focal_length > 0;
            context.messages.add_error(node.place_of(is_distance ? "focusdistance" : "lensfile"), problem);
            return;
        }
        // A mask lets light through within a circle around all of it, for every direction on the film.
        LensSystem open = lens_;
        if (mask_) open.set_stop(lens_.stop()->opening * mask_->reach());
        pupil_ = ExitPupil(open, diagonal / 2);
    }

    bool has_lens() const override { return true; }

    std::optional<CameraRay> ray(const CameraSample& sample) const override {
        // The picture stands on its head on the film.
        const Vec2d film{(0.5 - static_cast<double>(sample.film.x) / resolution_.x) * film_size_.x,
                         (static_cast<double>(sample.film.y) / resolution_.y - 0.5) * film_size_.y};
        const auto pupil = pupil_.sample(film, sample.lens);
        if (!pupil) return std::nullopt;
        const Vec3d from{film.x, film.y, 0}, d = pupil->p - from;
        const auto through = lens_.trace(from, d, mask_ ? &*mask_ : nullptr);
        if (!through) return std::nullopt;
        // What arrives at the film is the integral over the pupil of radiance cos^4 / z^2 (Kolb et al.,
        // section 4).
        const double cos2 = d.z * d.z / dot(d, d);
        const double weight = through->weight * cos2 * cos2 * pupil->area / (d.z * d.z);
        const Ray world{Vec3(world_from_camera_.point(through->o)),
                        Vec3(normalize(world_from_camera_.vector(through->d))), infinity,
                        lerp(sample.time, shutteropen, shutterclose)};
        return CameraRay{world, static_cast<float>(weight)};
    }

  private:
    bool read_lens(const Node& node, BuildContext& context) {
        const Place place = node.place_of("lensfile");
        try {
            lens_ = LensSystem(parse_lens(read_file(context.resolve(lensfile), std::size_t{1} << 20)));
        } catch (const std::runtime_error& e) {
            context.messages.add_error(place, fmt::format("lens file \"{}\": {}", lensfile, e.what()));
            return false;
        }
        const LensSurface* stop = lens_.stop();
        if (!stop) {
            if (aperturediameter || aperture != "circular")
                context.messages.add_warning(place,
                                             fmt::format("lens file \"{}\" has no aperture stop (a row with "
                                                         "radius 0); the aperture has no effect",
                                                         lensfile));
            return true;
        }
        const double wanted = static_cast<double>(aperturediameter.value_or(1)) * 0.5e-3;
        if (wanted > stop->opening * (1 + 1e-6))
            context.messages.add_warning(
                node.place_of("aperturediameter"),
                fmt::format("the aperture's diameter cannot be {} mm; the lens opens to {} mm", wanted * 2e3,
                            stop->opening * 2e3));
        lens_.set_stop(std::min(wanted, stop->opening));
        return true;
    }

    bool read_aperture(const Node& node, BuildContext& context) {
        if (aperture == "circular" || !lens_.stop()) return true;
        mask_ = ApertureMask::named(aperture);
        if (mask_) return true;
        try {
            mask_ = ApertureMask(read_image(context.resolve(aperture)));
        } catch (const std::runtime_error& e) {
            context.messages.add_error(
                node.place_of("aperture"),
                fmt::format(
                    "aperture \"{}\" is not circular, gaussian, square, pentagon or star, nor an image: {}",
                    aperture, e.what()));
        }
        return mask_.has_value();
    }

    Transform world_from_camera_;
    Vec2d resolution_{1, 1}, film_size_; ///< pixels, metres
    LensSystem lens_{{}};
    std::optional<ApertureMask> mask_;
    ExitPupil pupil_;
};

} // namespace

Kind<Camera> realistic_camera() {
    return make_kind<Camera, RealisticCamera>("realistic");
}

} // namespace alhazen
