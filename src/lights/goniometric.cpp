/// A light without size whose intensity in each direction a picture gives, as it is measured of lamps (Pharr
/// et al. 2023, section 12.2.3).
#include <fmt/format.h>

#include "image/pyramid.h"
#include "lights/emission_image.h"
#include "lights/point_like.h"
#include "math/equal_area.h"
#include "math/warp.h"

namespace alhazen {
namespace {

struct GoniometricLight final : PointLike {
    std::string filename;

    static void describe(Fields<GoniometricLight>& f) {
        f.about("Shines from one point, in each direction as strongly as an image says: a square equal-area "
                "octahedral map, whose middle looks along +y.");
        f.field("filename", &GoniometricLight::filename,
                "image of the factors on I; of a coloured one, the mean of red, green and blue")
            .required();
        describe_point_like(f, "radiant intensity where the image is 1");
        f.example("lamp", {make_string("filename", "lamp.exr"), make_rgb("I", 20, 20, 18)});
        f.example("lumens", {make_string("filename", "lamp.exr"), make_float("power", 800)});
    }
    void finish(const Node& node, BuildContext& context) {
        constexpr std::string_view owner = "light \"goniometric\"";
        auto image = load_emission_image(node, filename, owner, context);
        if (!image) return;
        if (image->width() != image->height()) {
            context.messages.add_error(node.find("filename")->place,
                                       fmt::format("image \"{}\" of {} has {} x {} pixels; it must be square "
                                                   "(an equal-area octahedral map)",
                                                   filename, owner, image->width(), image->height()));
            return;
        }
        set_image(*image);
        world_from_light_ = context.world_from_node;
        place(4 * pi * mean_, node, context);
    }

    std::optional<LightSample> sample(const LightReceiver& at, Vec2,
                                      const Wavelengths& lambda) const override {
        return sample_point(at, lambda, [&](const Direction& to_light) {
            return factor(normalize(world_from_light_.inverse_vector(-to_light.w))) /
                   to_light.distance_squared;
        });
    }
    std::optional<LeavingLight> sample_leaving(Vec2, Vec2 u2, const Wavelengths& lambda,
                                               float time) const override {
        const Vec3 w = sample_sphere(u2);
        return leave_point(w, factor(normalize(world_from_light_.inverse_vector(w))), sphere_pdf(), lambda,
                           time);
    }
    LeavingPdf pdf_leaving(Vec3, Vec3) const override { return {1, sphere_pdf()}; }
    std::optional<LightBounds> bounds() const override {
        LightBounds b = point_bounds();
        b.power *= mean_;
        return b;
    }

  private:
    void set_image(const Image& image) {
        side_ = image.width();
        double sum = 0;
        for (int y = 0; y < side_; ++y)
            for (int x = 0; x < side_; ++x) {
                Vec3 rgb = image.rgb(x, y);
                factors_.push_back(std::max(0.0f, (rgb.x + rgb.y + rgb.z) / 3));
                sum += static_cast<double>(factors_.back());
            }
        mean_ = static_cast<float>(sum / static_cast<double>(factors_.size()));
    }
    float factor(Vec3 w) const {
        // Maps of lamps have y upwards (pbrt-v4's convention), the equal-area map's axis is z.
        Vec2i texel = *nearest_texel(WrapMode::clamp, sphere_to_equal_area({w.x, w.z, w.y}), {side_, side_});
        return factors_[static_cast<std::size_t>(texel.y) * static_cast<std::size_t>(side_) +
                        static_cast<std::size_t>(texel.x)];
    }

    int side_ = 0;
    std::vector<float> factors_;
    float mean_ = 0;
    Transform world_from_light_;
};

} // namespace

Kind<Light> goniometric_light() {
    return make_kind<Light, GoniometricLight>("goniometric");
}

} // namespace alhazen
