/// Light from all around, as a sky gives it: the same from everywhere, or a picture (Pharr et al. 2023,
/// section 12.5), or a picture seen through a window.
#include <functional>
#include <memory>

#include <fmt/format.h>

#include "color/tone.h"
#include "image/image_colors.h"
#include "lights/environment_map.h"
#include "lights/light.h"
#include "lights/light_parts.h"
#include "lights/portal_map.h"
#include "math/warp.h"

namespace alhazen {
namespace {

struct InfiniteLight final : Light {
    IlluminantSpectrum L = white_light();
    float scale = 1;
    std::optional<float> illuminance;
    std::string filename;
    std::vector<Vec3> portal;
    bool compensate = true;

    static void describe(Fields<InfiniteLight>& f) {
        f.about("Surrounds the scene. An image is either square (an equal-area octahedral map, as pbrt-v4 "
                "has it) or "
                "twice as wide as high (equirectangular, the top row straight up); z points up.");
        f.field("L", &InfiniteLight::L, "radiance, the same from all directions").unit("W/(m^2 sr)");
        f.field("scale", &InfiniteLight::scale, "factor on the radiance").at_least(0);
        f.field("illuminance", &InfiniteLight::illuminance,
                "illuminance on a surface that faces up; when positive, the radiance is scaled so that scale "
                "1 gives it (with an image or a portal twice as much, as in pbrt-v4)")
            .unit("lx");
        f.field("filename", &InfiniteLight::filename, "image of the surroundings, instead of L");
        f.field(
             "portal", &InfiniteLight::portal,
             "four corners of a rectangle in world space, in order round its edge, through which all of the "
             "light comes; (corner 3 - corner 0) x (corner 1 - corner 0) points outwards")
            .unit("scene units");
        f.field("compensate", &InfiniteLight::compensate,
                "path tracers draw from the light only what is brighter than the mean, as directions of the "
                "BSDF find the rest (MIS compensation); the mean is the same without, and with a portal it "
                "is never done");
        f.example("grey sky", {make_rgb("L", .5f, .5f, .6f)});
        f.example("measured", {make_float("illuminance", 10), make_float("scale", .5f)});
        f.example("picture", {make_string("filename", "sky.exr"), make_float("scale", 2)});
        f.example("all of a picture", {make_string("filename", "sky.exr"), make_bool("compensate", false)});
        f.example("window", {make_string("filename", "sky.exr"),
                             make_array<Vec3>("portal", ValueType::point3,
                                              {{-2, -1, 5}, {-2, 3, 5}, {1, 3, 5}, {1, -1, 5}})});
        f.example("grey window", {make_rgb("L", .5f, .5f, .6f),
                                  make_array<Vec3>("portal", ValueType::point3,
                                                   {{-2, -1, 5}, {-2, 3, 5}, {1, 3, 5}, {1, -1, 5}})});
    }
    void finish(const Node& node, BuildContext& context) {
        space_ = LightSpace(context.world_from_node);
        if (!check(node, context)) return;
        take_default_color(node, "L", L);
        if (!filename.empty()) {
            load_image(node, context);
        } else if (!portal.empty()) {
            // As pbrt-v4, whose portals know pictures only: what is not rgb is not scaled to luminance 1.
            const Vec3 rgb = L.value.linear_srgb();
            constexpr int resolution = 64; // enough for samples that are uniform over the solid angle
            set_portal(
                resolution, [rgb](Vec3) { return rgb; }, srgb_space(), 2 * pi * luminance(rgb), context);
        } else {
            // A uniform sky of luminance 1 gives a horizontal surface pi.
            color_ = calibrated(L.value, scale_for(pi), context.color_mode);
        }
    }

    void prepare(const Bounds3& scene) override { extent_.set(scene); }
    std::optional<LightSample> sample(const LightReceiver& at, Vec2 u,
                                      const Wavelengths& lambda) const override {
        return sample(at, u, lambda, EnvironmentMap::Draw::all);
    }
    std::optional<LightSample> sample_beside_bsdf(const LightReceiver& at, Vec2 u,
                                                  const Wavelengths& lambda) const override {
        // BSDFs find a uniform sky better than anybody.
        if (compensate && !map_ && !portal_) return std::nullopt;
        return sample(at, u, lambda, beside_bsdf());
    }
    std::optional<LightSample> sample(const LightReceiver& at, Vec2 u, const Wavelengths& lambda,
                                      EnvironmentMap::Draw draw) const {
        LightSample s;
        if (portal_) {
            auto drawn = portal_->sample(at.p, u);
            if (!drawn) return std::nullopt;
            s.L = portal_->eval(drawn->texel, lambda) * image_scale_;
            s.wi = drawn->w;
            s.pdf = drawn->pdf;
        } else if (map_) {
            auto drawn = map_->sample(u, draw);
            s.L = map_->eval(drawn.texel, lambda) * image_scale_;
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
    Spectrum escaped(Vec3 p, Vec3 d, const Wavelengths& lambda) const override {
        if (portal_) {
            auto texel = portal_->texel_seen(p, d);
            return texel ? portal_->eval(*texel, lambda) * image_scale_ : Spectrum(0);
        }
        if (map_) return map_->eval(map_->texel_of(space_.to_light(d)), lambda) * image_scale_;
        return color_.eval(lambda);
    }
    float pdf_escaped(const LightReceiver& at, Vec3 d) const override {
        return pdf_escaped(at, d, EnvironmentMap::Draw::all);
    }
    float pdf_escaped(const LightReceiver& at, Vec3 d, EnvironmentMap::Draw draw) const {
        if (portal_) return portal_->pdf(at.p, d);
        return map_ ? map_->pdf(space_.to_light(d), draw) * space_.stretch(d) : sphere_pdf();
    }
    float pdf_escaped_beside_bsdf(const LightReceiver& at, Vec3 d) const override {
        if (compensate && !map_ && !portal_) return 0;
        return pdf_escaped(at, d, beside_bsdf());
    }
    /// From a place of the disk that the light of the drawn direction comes through.
    std::optional<LeavingLight> sample_leaving(Vec2 u1, Vec2 u2, const Wavelengths& lambda,
                                               float time) const override {
        if (extent_.radius == 0) return std::nullopt;
        if (portal_) return sample_leaving_through_portal(u1, u2, lambda, time);
        auto from = sample({extent_.center, {}}, u2, lambda);
        if (!from) return std::nullopt;
        LeavingLight s;
        s.ray = {extent_.before(-from->wi, u1), -from->wi, infinity, time};
        s.L = from->L;
        s.pdf_position = 1 / extent_.disk_area();
        s.pdf_direction = from->pdf;
        s.p = s.ray.o;
        return s;
    }
    LeavingPdf pdf_leaving(Vec3, Vec3 w) const override {
        return {1 / extent_.disk_area(), portal_ ? sphere_pdf() : pdf_escaped({}, -w)};
    }
    Spectrum power(const Wavelengths& lambda) const override {
        return color_.eval(lambda) * (portal_ ? 1.0f : 4 * pi * extent_.disk_area());
    }

  private:
    EnvironmentMap::Draw beside_bsdf() const {
        return compensate ? EnvironmentMap::Draw::bright : EnvironmentMap::Draw::all;
    }
    bool check(const Node& node, BuildContext& context) const {
        const std::size_t errors = context.messages.error_count();
        if (node.find("L") && !filename.empty())
            context.messages.add_error(
                node.find("L")->place,
                "light \"infinite\" has both \"L\" and \"filename\"; it takes one of them");
        if (node.find("portal") && portal.size() != 4)
            context.messages.add_error(
                node.find("portal")->place,
                fmt::format(
                    "parameter \"portal\" has {} points; it must have four, the corners of a rectangle",
                    portal.size()));
        else if (!portal.empty() && !is_rectangle(corners()))
            context.messages.add_error(node.find("portal")->place,
                                       "parameter \"portal\" must give the corners of a rectangle, in order "
                                       "round its edge; these points do not");
        return context.messages.error_count() == errors;
    }
    /// scale, or, where an illuminance is asked for, what gives it when scale 1 gives a surface that faces up
    /// that_of_1.
    float scale_for(float that_of_1) const {
        if (!is_given(illuminance)) return scale;
        return that_of_1 > 0 ? scale * *illuminance / that_of_1 : 0;
    }
    void load_image(const Node& node, BuildContext& context) {
        constexpr std::string_view owner = "light \"infinite\"";
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
        auto map = std::make_shared<const EnvironmentMap>(*image, context.color_mode);
        // pbrt-v4 takes each pixel of the upper half for half of its solid angle.
        const float counted_illuminance = map->illuminance() / 2;
        if (!portal.empty()) {
            auto sky = blended_sky(*image);
            set_portal(
                image->height(), [&](Vec3 w) { return sky(space_.to_light(w)); }, color_space_of(*image),
                counted_illuminance, context);
            return;
        }
        map_ = std::move(map);
        const float s = scale_for(counted_illuminance);
        image_scale_ = s * map_->light_scale();
        // For power(), the mean colour stands for the mean of all the texels' spectra.
        color_ =
            calibrated(SpectrumValue::illuminant_rgb(srgb_space(), map_->mean_rgb()), s, context.color_mode);
    }
    void set_portal(int resolution, const std::function<Vec3(Vec3)>& sky, const RgbColorSpace& colors,
                    float illuminance_of_1, BuildContext& context) {
        portal_ = std::make_shared<const PortalMap>(corners(), resolution, sky, colors, context.color_mode);
        const float s = scale_for(illuminance_of_1);
        image_scale_ = s * portal_->light_scale();
        color_ =
            calibrated(SpectrumValue::illuminant_rgb(srgb_space(), portal_->flux()), s, context.color_mode);
    }
    PortalCorners corners() const { return {portal[0], portal[1], portal[2], portal[3]}; }
    /// Which rays of the scene's disk come through the window is not known before they are drawn: any
    /// direction may.
    std::optional<LeavingLight> sample_leaving_through_portal(Vec2 u1, Vec2 u2, const Wavelengths& lambda,
                                                              float time) const {
        const Vec3 towards_light = sample_sphere(u2);
        LeavingLight s;
        s.ray = {extent_.before(-towards_light, u1), -towards_light, infinity, time};
        // Seen from where the ray has crossed the scene.
        s.L = escaped(s.ray.at(2 * extent_.radius), towards_light, lambda);
        if (s.L.is_black()) return std::nullopt;
        s.pdf_position = 1 / extent_.disk_area();
        s.pdf_direction = sphere_pdf();
        s.p = s.ray.o;
        return s;
    }

    SpectrumValue color_; ///< radiance; of a map, its mean; of a portal, what it lets through
    std::shared_ptr<const EnvironmentMap> map_;
    std::shared_ptr<const PortalMap> portal_;
    float image_scale_ = 1;
    LightSpace space_;
    SceneExtent extent_;
};

} // namespace

Kind<Light> infinite_light() {
    return make_kind<Light, InfiniteLight>("infinite");
}

} // namespace alhazen
