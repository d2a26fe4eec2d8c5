/// A slide projector without size: the picture that it throws is sharp at every distance (Pharr et al. 2023,
/// section 12.2.2). Each pixel's value is the radiant intensity towards it, so that a white slide thrown onto
/// a wall fades towards its corners.
#include "color/tone.h"
#include "lights/emission_image.h"
#include "lights/light.h"
#include "lights/light_parts.h"

namespace alhazen {
namespace {

struct ProjectionLight final : Light {
    std::string filename;
    float fov = 90;
    float scale = 1;
    std::optional<float> power_target;

    static void describe(Fields<ProjectionLight>& f) {
        f.about("Projects an image from one point along +z, its top towards +y.");
        f.field("filename", &ProjectionLight::filename, "image of the radiant intensity").required();
        f.field("fov", &ProjectionLight::fov, "angle that the image's shorter side covers")
            .in(0, 180)
            .above(0)
            .unit("degrees");
        f.field("scale", &ProjectionLight::scale, "factor on the intensity").at_least(0);
        f.field("power", &ProjectionLight::power_target,
                "luminous flux; when positive, the intensity is scaled so that scale 1 gives it")
            .unit("lm");
        f.example("slide", {make_string("filename", "slide.png"), make_float("fov", 45)});
        f.example("lumens", {make_string("filename", "slide.png"), make_float("power", 1000)});
    }
    void finish(const Node& node, BuildContext& context) {
        if (fov >= 180) {
            context.messages.add_error(node.find("fov")->place,
                                       "parameter \"fov\" is 180; it must be less, since a flat image cannot "
                                       "cover half of all directions");
            return;
        }
        auto image = load_emission_image(node, filename, "light \"projection\"", context);
        if (!image) return;
        set_window(image->size());
        image_ = std::make_shared<const EmissionImage>(*image, context.color_mode);
        const Vec3 flux = integrate(*image);
        float s = scale;
        if (is_given(power_target)) s *= luminance(flux) > 0 ? *power_target / luminance(flux) : 0.0f;
        image_scale_ = s * image_->light_scale();
        flux_ = calibrated(SpectrumValue::illuminant_rgb(srgb_space(), flux), s, context.color_mode);
        space_ = LightSpace(context.world_from_node);
        p_ = context.world_from_node.point(Vec3());
    }

    bool is_delta() const override { return true; }
    std::optional<LightSample> sample(const LightReceiver& at, Vec2,
                                      const Wavelengths& lambda) const override {
        auto to_light = direction_between(at.p, p_);
        if (!to_light) return std::nullopt;
        auto texel = texel_towards(space_.to_light(-to_light->w));
        if (!texel) return std::nullopt;
        LightSample s;
        s.L = image_->eval(*texel, lambda) * (image_scale_ / to_light->distance_squared);
        if (s.L.is_black()) return std::nullopt;
        s.wi = to_light->w;
        s.pdf = 1;
        s.p = p_;
        return s;
    }
    /// Through a point of the slide, each as likely.
    std::optional<LeavingLight> sample_leaving(Vec2, Vec2 u2, const Wavelengths& lambda,
                                               float time) const override {
        const Vec3 local = normalize(Vec3{(2 * u2.x - 1) * half_.x, (2 * u2.y - 1) * half_.y, 1});
        const auto texel = texel_towards(local);
        if (!texel) return std::nullopt;
        LeavingLight s;
        s.L = image_->eval(*texel, lambda) * image_scale_;
        if (s.L.is_black()) return std::nullopt;
        s.ray = {p_, space_.to_world(local), infinity, time};
        s.pdf_position = 1;
        s.pdf_direction = pdf_leaving({}, s.ray.d).direction;
        s.p = p_;
        return s;
    }
    LeavingPdf pdf_leaving(Vec3, Vec3 w) const override {
        const Vec3 local = space_.to_light(w);
        if (!texel_towards(local)) return {1, 0};
        const float per_slide = 1 / (4 * half_.x * half_.y * local.z * local.z * local.z);
        return {1, per_slide * space_.stretch(w)};
    }
    std::optional<LightBounds> bounds() const override {
        LightBounds b;
        b.bounds = {p_, p_};
        // As of a point light that is everywhere as bright as the slide's mean.
        b.power = 4 * pi * brightness(flux_) / solid_angle_;
        if (!keeps_angles(space_.world_from_light())) return b;
        b.axis = space_.to_world(Vec3(0, 0, 1));
        b.cos_normals = 1 / std::sqrt(1 + length_squared(half_));
        // A little, so that rounding never cuts into the corners.
        b.cos_falloff = std::cos(2e-3f);
        return b;
    }
    Spectrum power(const Wavelengths& lambda) const override { return flux_.eval(lambda); }

  private:
    void set_window(Vec2i size) {
        const float half = std::tan(radians(fov) / 2);
        const float aspect = static_cast<float>(size.x) / static_cast<float>(size.y);
        half_ = aspect > 1 ? Vec2{half * aspect, half} : Vec2{half, half / aspect};
    }
    /// The pixel that light in the unit vector's direction goes through.
    std::optional<Vec2i> texel_towards(Vec3 w) const {
        // What is almost across the axis is behind the lens, as in pbrt-v4.
        constexpr float behind = 1e-3f;
        if (w.z < behind) return std::nullopt;
        Vec2 at{w.x / (w.z * half_.x), w.y / (w.z * half_.y)};
        if (!(std::abs(at.x) <= 1 && std::abs(at.y) <= 1)) return std::nullopt;
        return image_->nearest({(1 + at.x) / 2, (1 - at.y) / 2});
    }
    /// Of the image's colours over the solid angles of its pixels, which shrink with the cube of the cosine.
    Vec3 integrate(const Image& image) {
        Vec3d sum;
        double solid_angle = 0;
        const double w = image.width(), h = image.height();
        const double pixel_area = 4 * static_cast<double>(half_.x * half_.y) / (w * h);
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x) {
                const double px = ((2 * x + 1) / w - 1) * static_cast<double>(half_.x),
                             py = ((2 * y + 1) / h - 1) * static_cast<double>(half_.y);
                const double omega = pixel_area * std::pow(1 + px * px + py * py, -1.5);
                sum += Vec3d(emitted_rgb(image, x, y)) * omega;
                solid_angle += omega;
            }
        solid_angle_ = static_cast<float>(solid_angle);
        return Vec3(sum);
    }

    std::shared_ptr<const EmissionImage> image_;
    float image_scale_ = 1;
    SpectrumValue flux_;    ///< through the whole image
    Vec2 half_{1, 1};       ///< half of the image's sides in the plane z = 1
    float solid_angle_ = 1; ///< of the image
    LightSpace space_;
    Vec3 p_;
};

} // namespace

Kind<Light> projection_light() {
    return make_kind<Light, ProjectionLight>("projection");
}

} // namespace alhazen
