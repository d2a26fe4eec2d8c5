/// A glowing surface that looks equally bright from every direction (Pharr et al. 2023, section 12.4).
#include "color/tone.h"
#include "image/image_colors.h"
#include "lights/area_light.h"
#include "lights/emission_image.h"
#include "lights/light_parts.h"
#include "math/warp.h"

namespace alhazen {
namespace {

struct DiffuseAreaLight final : AreaLight {
    IlluminantSpectrum L = white_light();
    float scale = 1;
    std::optional<float> power_target;
    bool twosided = false;
    std::string filename;

    static void describe(Fields<DiffuseAreaLight>& f) {
        f.about(
            "Makes a shape glow, equally bright from every direction on the side that its normals point to.");
        f.field("L", &DiffuseAreaLight::L, "emitted radiance").unit("W/(m^2 sr)");
        f.field("scale", &DiffuseAreaLight::scale, "factor on the radiance").at_least(0);
        f.field("power", &DiffuseAreaLight::power_target,
                "luminous flux of each triangle, sphere ... of the shape; when positive, the radiance is "
                "scaled so "
                "that scale 1 gives it")
            .unit("lm");
        f.field("twosided", &DiffuseAreaLight::twosided, "whether both sides glow");
        f.field("filename", &DiffuseAreaLight::filename,
                "image of the radiance over the shape's (u, v), v upwards, instead of L");
        f.example("panel", {make_rgb("L", 17, 12, 4)});
        f.example("both sides", {make_bool("twosided", true), make_float("scale", 3)});
        f.example("lumens", {make_float("power", 1000)});
    }
    void finish(const Node& node, BuildContext& context) {
        float s = scale;
        take_default_color(node, "L", L);
        if (!filename.empty()) {
            if (node.find("L")) {
                context.messages.add_error(
                    node.find("L")->place,
                    "area light \"diffuse\" has both \"L\" and \"filename\"; it takes one of them");
                return;
            }
            auto image = load_emission_image(node, filename, "area light \"diffuse\"", context);
            if (!image) return;
            set_image(*image, context.color_mode);
            if (is_given(power_target)) s = image_luminance_ > 0 ? s / image_luminance_ : 0.0f;
        }
        color_ = calibrated(image_ ? mean_color_ : L.value, s, context.color_mode);
        image_scale_ = image_ ? s * image_->light_scale() : 0.0f;
    }
    bool may_join() const override { return !is_given(power_target); }
    std::unique_ptr<AreaLight> attach(const Shape& shape, std::uint32_t primitive) const override {
        auto light = std::make_unique<DiffuseAreaLight>(*this);
        light->shape_ = &shape;
        light->primitive_ = primitive;
        light->area_ = shape.area(primitive);
        light->is_invisible_ = shape.alpha.is_constant() && shape.alpha.constant() == 0;
        if (is_given(power_target)) {
            float flux = pi * light->area_ * sides(); // of luminance 1
            float s = flux > 0 ? *power_target / flux : 0.0f;
            light->color_ = color_.scaled(s);
            light->image_scale_ = image_scale_ * s;
        }
        return light;
    }

    std::optional<LightSample> sample(const LightReceiver& at, Vec2 u,
                                      const Wavelengths& lambda) const override {
        if (!shape_) return std::nullopt;
        auto point = shape_->sample_from(primitive_, at.p, u);
        if (!point || !(point->pdf > 0) || !std::isfinite(point->pdf)) return std::nullopt;
        auto to_light = direction_between(at.p, point->p);
        if (!to_light) return std::nullopt;
        LightSample s;
        s.L = radiance(point->ng, -to_light->w, point->uv, lambda);
        if (!is_invisible_) s.L *= presence({point->p, point->ng, point->uv});
        if (s.L.is_black()) return std::nullopt;
        s.wi = to_light->w;
        s.pdf = point->pdf;
        if (is_invisible_) {
            // Rays pass through it, so it is sampled as delta lights are: with density 1.
            s.L = s.L / s.pdf;
            s.pdf = 1;
        }
        s.p = point->p;
        s.p_error = point->p_error;
        s.ng = point->ng;
        s.primitive_u = point->uv.x;
        s.primitive_v = point->uv.y;
        return s;
    }
    std::optional<LeavingLight> sample_leaving(Vec2 u1, Vec2 u2, const Wavelengths& lambda,
                                               float time) const override {
        if (!shape_) return std::nullopt;
        ShapeSample point = shape_->sample(primitive_, u1);
        Vec3 side = point.ng;
        if (twosided) {
            // The first half of the numbers is for the front.
            side = u2.x < 0.5f ? point.ng : -point.ng;
            u2.x = std::min(2 * (u2.x < 0.5f ? u2.x : u2.x - 0.5f), one_minus_epsilon);
        }
        Vec3 w = Frame::from_z(side).to_world(sample_cosine_hemisphere(u2));
        LeavingLight s;
        s.cosine = abs_dot(w, point.ng);
        s.L = radiance(point.ng, w, point.uv, lambda);
        if (!is_invisible_) s.presence = presence({point.p, point.ng, point.uv});
        s.L *= s.presence;
        LeavingPdf pdf = pdf_leaving(point.ng, w);
        if (s.L.is_black() || !(pdf.position > 0 && pdf.direction > 0)) return std::nullopt;
        s.ray = {offset_origin(point.p, point.p_error, point.ng, w), w, infinity, time};
        s.pdf_position = pdf.position;
        s.pdf_direction = pdf.direction;
        s.p = point.p;
        s.p_error = point.p_error;
        s.ng = point.ng;
        s.uv = point.uv;
        return s;
    }
    LeavingPdf pdf_leaving(Vec3 ng, Vec3 w) const override {
        float cosine = dot(ng, w);
        return {1 / area_, cosine_hemisphere_pdf(twosided ? std::abs(cosine) : cosine) / sides()};
    }
    bool is_delta() const override { return is_invisible_; }
    bool has_extent() const override { return true; }
    Spectrum emitted(const Hit& hit, const Wavelengths& lambda) const override {
        return radiance(hit.ng, hit.wo, hit.uv, lambda);
    }
    float pdf_hit(const LightReceiver& at, const Hit& hit, Vec3 wi) const override {
        return shape_ && !is_invisible_ ? shape_->pdf_from(primitive_, at.p, hit, wi) : 0;
    }
    std::optional<LightBounds> bounds() const override {
        LightBounds b;
        if (!shape_) return b;
        b.bounds = shape_->bounds(primitive_);
        auto cone = shape_->normals(primitive_);
        b.axis = cone.axis;
        b.cos_normals = cone.cosine;
        b.cos_falloff = 0;
        b.power = pi * area_ * brightness(color_); // of one side: no point sees both
        b.two_sided = twosided;
        return b;
    }
    Spectrum power(const Wavelengths& lambda) const override {
        return color_.eval(lambda) * (pi * area_ * sides());
    }

  private:
    float sides() const { return twosided ? 2.0f : 1.0f; }
    /// Fraction of the surface that is there. Where it is there by chance, rays meet it that often, and
    /// samples count that much.
    float presence(const TexturePoint& at) const { return std::clamp(shape_->alpha.eval(at), 0.0f, 1.0f); }
    Spectrum radiance(Vec3 ng, Vec3 w, Vec2 uv, const Wavelengths& lambda) const {
        if (!twosided && !(dot(ng, w) > 0)) return 0;
        if (!image_) return color_.eval(lambda);
        return image_->bilinear({uv.x, 1 - uv.y}, lambda) * image_scale_;
    }
    void set_image(const Image& image, ColorMode mode) {
        image_ = std::make_shared<const EmissionImage>(image, mode);
        Vec3d sum;
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x) sum += Vec3d(emitted_rgb(image, x, y));
        const Vec3 mean = convert_rgb(color_space_of(image), srgb_space()) *
                          Vec3(sum / (static_cast<double>(image.width()) * image.height()));
        mean_color_ = SpectrumValue::illuminant_rgb(srgb_space(), mean);
        image_luminance_ = luminance(mean);
    }

    // Of the description.
    std::shared_ptr<const EmissionImage> image_;
    SpectrumValue mean_color_;
    float image_luminance_ = 1;
    SpectrumValue color_; ///< radiance; of an image, its mean
    float image_scale_ = 0;
    // Of the light once it is attached.
    const Shape* shape_ = nullptr;
    std::uint32_t primitive_ = 0;
    float area_ = 0;
    bool is_invisible_ = false;
};

} // namespace

Kind<AreaLight> diffuse_area_light() {
    return make_kind<AreaLight, DiffuseAreaLight>("diffuse");
}

} // namespace alhazen
