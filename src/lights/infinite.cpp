/// Light from all around, as a sky gives it: the same from everywhere, or a picture (Pharr et al. 2023,
/// section 12.5).
#include <fmt/format.h>

#include "lights/environment_map.h"
#include "lights/light.h"
#include "lights/light_parts.h"
#include "math/warp.h"

namespace alhazen {
namespace {

struct InfiniteLight final : Light {
    IlluminantSpectrum L = white_light();
    float scale = 1;
    std::optional<float> illuminance;
    std::string filename;

    static void describe(Fields<InfiniteLight>& f) {
        f.about("Surrounds the scene. An image is either square (an equal-area octahedral map, as pbrt-v4 "
                "has it) or "
                "twice as wide as high (equirectangular, the top row straight up); z points up.");
        f.field("L", &InfiniteLight::L, "radiance, the same from all directions").unit("W/(m^2 sr)");
        f.field("scale", &InfiniteLight::scale, "factor on the radiance").at_least(0);
        f.field("illuminance", &InfiniteLight::illuminance,
                "illuminance on a surface that faces up; when positive, the radiance is scaled so that scale "
                "1 gives it")
            .unit("lx");
        f.field("filename", &InfiniteLight::filename, "image of the surroundings, instead of L");
        f.example("grey sky", {make_rgb("L", .5f, .5f, .6f)});
        f.example("measured", {make_float("illuminance", 10), make_float("scale", .5f)});
    }
    void finish(const Node& node, BuildContext& context) {
        space_ = LightSpace(context.world_from_node);
        if (filename.empty()) {
            // A uniform sky of luminance 1 gives a horizontal surface pi.
            float s = scale * (is_given(illuminance) ? *illuminance / pi : 1.0f);
            color_ = calibrated(L.value, s, context.color_mode);
        } else {
            load_map(node, context);
        }
    }

    void prepare(const Bounds3& scene) override { extent_.set(scene); }
    std::optional<LightSample> sample(const LightReceiver& at, Vec2 u,
                                      const Wavelengths& lambda) const override {
        LightSample s;
        if (map_) {
            auto drawn = map_->sample(u);
            s.L = map_->eval(drawn.texel, lambda) * map_scale_;
            s.wi = space_.to_world(drawn.w);
            s.pdf = drawn.pdf * space_.stretch(s.wi);
        } else {
            s.L = color_.eval(lambda);
            s.wi = sample_sphere(u);
            s.pdf = sphere_pdf();
        }
        if (s.L.is_black() || !(s.pdf > 0)) return std::nullopt;
        s.p = extent_.beyond(at.p, s.wi);
        return s;
    }
    bool is_infinite() const override { return true; }
    Spectrum escaped(Vec3 d, const Wavelengths& lambda) const override {
        if (!map_) return color_.eval(lambda);
        return map_->eval(map_->texel_of(space_.to_light(d)), lambda) * map_scale_;
    }
    float pdf_escaped(const LightReceiver&, Vec3 d) const override {
        return map_ ? map_->pdf(space_.to_light(d)) * space_.stretch(d) : sphere_pdf();
    }
    /// From a place of the disk that the light of the drawn direction comes through.
    std::optional<LeavingLight> sample_leaving(Vec2 u1, Vec2 u2, const Wavelengths& lambda,
                                               float time) const override {
        auto from = sample({extent_.center, {}}, u2, lambda);
        if (!from || extent_.radius == 0) return std::nullopt;
        LeavingLight s;
        s.ray = {extent_.before(-from->wi, u1), -from->wi, infinity, time};
        s.L = from->L;
        s.pdf_position = 1 / extent_.disk_area();
        s.pdf_direction = from->pdf;
        s.p = s.ray.o;
        return s;
    }
    LeavingPdf pdf_leaving(Vec3, Vec3 w) const override {
        return {1 / extent_.disk_area(), pdf_escaped({}, -w)};
    }
    Spectrum power(const Wavelengths& lambda) const override {
        return color_.eval(lambda) * (4 * pi * extent_.disk_area());
    }

  private:
    void load_map(const Node& node, BuildContext& context) {
        constexpr std::string_view owner = "light \"infinite\"";
        if (node.find("L")) {
            context.messages.add_error(
                node.find("L")->place,
                "light \"infinite\" has both \"L\" and \"filename\"; it takes one of them");
            return;
        }
        auto image = load_emission_image(node, filename, owner, context);
        if (!image) return;
        if (!EnvironmentMap::is_valid_size(image->size())) {
            context.messages.add_error(node.find("filename")->place,
                                       fmt::format("image \"{}\" of {} has {} x {} pixels; it must be square "
                                                   "(an equal-area octahedral map) or "
                                                   "twice as wide as high (equirectangular)",
                                                   filename, owner, image->width(), image->height()));
            return;
        }
        map_ = std::make_shared<const EnvironmentMap>(*image, context.color_mode);
        float s = scale;
        if (is_given(illuminance)) s *= map_->illuminance() > 0 ? *illuminance / map_->illuminance() : 0.0f;
        map_scale_ = s * map_->light_scale();
        // For power(), the mean colour stands for the mean of all the texels' spectra.
        color_ =
            calibrated(SpectrumValue::illuminant_rgb(srgb_space(), map_->mean_rgb()), s, context.color_mode);
    }
    SpectrumValue color_; ///< radiance; of a map, its mean
    std::shared_ptr<const EnvironmentMap> map_;
    float map_scale_ = 1;
    LightSpace space_;
    SceneExtent extent_;
};

} // namespace

Kind<Light> infinite_light() {
    return make_kind<Light, InfiniteLight>("infinite");
}

} // namespace alhazen
