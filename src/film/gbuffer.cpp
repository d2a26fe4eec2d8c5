/// A picture with what denoisers and compositors want to know of each pixel beside its colour: where the
/// first surface is, which way it faces, its albedo, and how much the samples vary (channels and their names
/// as pbrt-v4 has them).
///
/// Features are means over the samples that meet a surface; which samples there are already follows the
/// filter. Normals are then made unit again.
#include "base/threads.h"
#include "film/picture_film.h"

namespace alhazen {

enum class FeatureSpace { camera, world };
template <>
struct EnumNames<FeatureSpace> {
    static constexpr std::array names{"camera", "world"};
};

namespace {

/// Mean and variance of a stream of numbers (Welford 1962).
struct RunningVariance {
    Vec3d mean, squares; ///< squares: of the distances from the mean, summed
    double count = 0;

    void add(Vec3d v) {
        count += 1;
        const Vec3d before = v - mean;
        mean += before / count;
        squares += before * (v - mean);
    }
    Vec3d variance() const { return count > 1 ? squares / (count - 1) : Vec3d(); }
};

struct GBufferFilm final : PictureFilm {
    FeatureSpace coordinatesystem = FeatureSpace::camera;

    /// Places far away want more digits than 16 bits have.
    GBufferFilm() { savefp16 = false; }

    static void describe(Fields<GBufferFilm>& f) {
        f.about(
            "A picture with what the camera sees first, for denoising and compositing: albedo (Albedo), "
            "place (P), surface parameters (u, v), change of depth from pixel to pixel (dzdx, dzdy), "
            "geometric and shading normal (N, Ns), variance of the samples, and that over their mean "
            "(Variance, RelativeVariance; of what camera paths find, without light that is brought to the "
            "pixel by others, as bdpt does). OpenEXR files hold all channels, other files the colour.");
        describe_picture(f);
        f.field("coordinatesystem", &GBufferFilm::coordinatesystem,
                "of places and normals: the camera's, looking along +z, or the world's");
        f.example("small", {make_integer("xresolution", 64), make_integer("yresolution", 64)});
    }
    void finish(const Node& node, BuildContext& context) {
        PictureFilm::finish(node, context);
        if (coordinatesystem != FeatureSpace::camera) return;
        output_from_world_ = context.world_from_camera.inverse();
        camera_movement_ = context.camera_movement;
    }

    void start(ColorMode mode) override {
        PictureFilm::start(mode);
        const std::size_t count = pixel_count();
        features_ = BigArray<Features>(count);
        parallel_ranges(count, 16384, [this](std::size_t begin, std::size_t end) {
            std::fill(features_.data() + begin, features_.data() + end, Features{});
        });
    }
    void add(Vec2i pixel, Spectrum L, const Wavelengths& lambda, float weight) override {
        PictureFilm::add(pixel, L, lambda, weight);
        features_[index(pixel)].color.add(Vec3d(output_color(measured(L, lambda))));
    }
    bool wants_surfaces() const override { return true; }
    void add_surface(Vec2i pixel, const VisibleSurface& surface) override {
        if (camera_movement_) return add(pixel, surface, camera_movement_->at(surface.time).inverse());
        add(pixel, surface, output_from_world_);
    }
    int channels() const override { return 3 + static_cast<int>(names().size()); }
    Image image() const override;

  private:
    struct Features {
        Vec3d p, n, ns, albedo;
        double u = 0, v = 0, dzdx = 0, dzdy = 0;
        double count = 0;
        RunningVariance color;
    };

    static const std::vector<std::string>& names() {
        static const std::vector<std::string> names{"Albedo.R",
                                                    "Albedo.G",
                                                    "Albedo.B",
                                                    "P.X",
                                                    "P.Y",
                                                    "P.Z",
                                                    "u",
                                                    "v",
                                                    "dzdx",
                                                    "dzdy",
                                                    "N.X",
                                                    "N.Y",
                                                    "N.Z",
                                                    "Ns.X",
                                                    "Ns.Y",
                                                    "Ns.Z",
                                                    "Variance.R",
                                                    "Variance.G",
                                                    "Variance.B",
                                                    "RelativeVariance.R",
                                                    "RelativeVariance.G",
                                                    "RelativeVariance.B"};
        return names;
    }
    /// As if lit by the colour space's white.
    Vec3 albedo_color(Spectrum albedo, const Wavelengths& lambda) const;

    void add(Vec2i pixel, const VisibleSurface& surface, const Transform& output_from_world) {
        Features& f = features_[index(pixel)];
        f.count += 1;
        f.p += Vec3d(output_from_world.point(surface.p));
        f.n += Vec3d(output_from_world.normal(surface.n));
        f.ns += Vec3d(output_from_world.normal(surface.ns));
        f.u += static_cast<double>(surface.uv.x);
        f.v += static_cast<double>(surface.uv.y);
        f.dzdx += static_cast<double>(output_from_world.vector(surface.dpdx).z);
        f.dzdy += static_cast<double>(output_from_world.vector(surface.dpdy).z);
        f.albedo += Vec3d(albedo_color(surface.albedo, surface.lambda));
    }

    Transform output_from_world_;
    std::shared_ptr<const MovingTransform> camera_movement_; ///< instead, where the camera moves
    BigArray<Features> features_;
};

Vec3 GBufferFilm::albedo_color(Spectrum albedo, const Wavelengths& lambda) const {
    static const Sensor eye;
    if (lambda.mode == ColorMode::rgb)
        return convert_rgb(srgb_space(), color_space()) * eye.to_sensor_rgb(albedo, lambda);
    const Spectrum lit = albedo * color_space().illuminant->eval(lambda.lambda) * (1 / cie_y_integral);
    return color_space().from_xyz(eye.to_sensor_rgb(lit, lambda));
}

Image GBufferFilm::image() const {
    Image image = image_with(names());
    auto out = image.values();
    const auto stride = static_cast<std::size_t>(image.channels());
    for (std::size_t i = 0; i < features_.size(); ++i) {
        const Features& f = features_[i];
        float* value = &out[i * stride + 3];
        auto put = [&](double v) { *value++ = static_cast<float>(v); };
        auto put_all = [&](Vec3d v) {
            for (int c = 0; c < 3; ++c) put(v[c]);
        };
        const double n = std::max(f.count, 1.0);
        auto unit = [](Vec3d v) { return length_squared(v) > 0 ? normalize(v) : v; };
        put_all(f.albedo / n);
        put_all(f.p / n);
        put(f.u / n);
        put(f.v / n);
        put(std::abs(f.dzdx / n));
        put(std::abs(f.dzdy / n));
        put_all(unit(f.n));
        put_all(unit(f.ns));
        const Vec3d variance = f.color.variance();
        put_all(variance);
        for (int c = 0; c < 3; ++c) put(f.color.mean[c] != 0 ? variance[c] / f.color.mean[c] : 0);
    }
    return image;
}

} // namespace

Kind<Film> gbuffer_film() {
    return make_kind<Film, GBufferFilm>("gbuffer");
}

} // namespace alhazen
