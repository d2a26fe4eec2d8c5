#include "lights/emission_image.h"

#include <stdexcept>

#include <fmt/format.h>

#include "base/threads.h"
#include "describe/context.h"
#include "image/codec.h"
#include "image/image_colors.h"
#include "image/pyramid.h"
#include "image/statistics.h"

namespace alhazen {

EmissionImage::EmissionImage(const Image& image, ColorMode mode)
    : space_(&color_space_of(image)), size_(image.size()),
      light_scale_(SpectrumValue::illuminant_rgb(*space_, Vec3(1)).light_scale(mode)),
      texels_(static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height())) {
    // Fitting spectra takes microseconds a texel.
    parallel_ranges(texels_.size(), 4096,
                    [&](std::size_t begin, std::size_t end) { fill(image, begin, end, mode); });
}

void EmissionImage::fill(const Image& image, std::size_t first, std::size_t last, ColorMode mode) {
    std::vector<Vec3> colors;
    colors.reserve(last - first);
    const Matrix3 srgb_from_rgb = convert_rgb(*space_, srgb_space());
    for (std::size_t i = first; i < last; ++i) {
        auto width = static_cast<std::size_t>(size_.x);
        Vec3 rgb = emitted_rgb(image, static_cast<int>(i % width), static_cast<int>(i / width));
        if (mode == ColorMode::rgb) {
            if (space_ != &srgb_space()) rgb = srgb_from_rgb * rgb;
            texels_[i] = {{rgb.x, rgb.y, rgb.z}, 1};
            continue;
        }
        // At half of the range, where spectra are smooth, as illuminants are everywhere.
        texels_[i].scale = 2 * max_component(rgb);
        colors.push_back(texels_[i].scale > 0 ? rgb * (1 / texels_[i].scale) : Vec3(0.5f));
    }
    if (mode == ColorMode::rgb) return;
    std::vector<SigmoidCoefficients> fits(colors.size());
    upsample(*space_, colors, fits);
    for (std::size_t i = first; i < last; ++i) {
        const SigmoidCoefficients& s = fits[i - first];
        texels_[i] = {{s.c0, s.c1, s.c2}, texels_[i].scale};
    }
}

Spectrum EmissionImage::eval(Vec2i texel, const Wavelengths& lambda) const {
    const Texel& t = texels_[static_cast<std::size_t>(texel.y) * static_cast<std::size_t>(size_.x) +
                             static_cast<std::size_t>(texel.x)];
    if (lambda.mode == ColorMode::rgb) return {t.c[0], t.c[1], t.c[2], (t.c[0] + t.c[1] + t.c[2]) / 3};
    if (t.scale == 0) return 0;
    SigmoidCoefficients sigmoid{t.c[0], t.c[1], t.c[2]};
    return sigmoid.eval(lambda.lambda) * space_->illuminant->eval(lambda.lambda) * t.scale;
}

Spectrum EmissionImage::bilinear(Vec2 uv, const Wavelengths& lambda) const {
    Spectrum sum = 0;
    for (const BilinearTap& tap : bilinear_taps(WrapMode::clamp, uv, size_))
        if (tap.weight != 0) sum += eval(tap.texel, lambda) * tap.weight;
    return sum;
}

Vec2i EmissionImage::nearest(Vec2 uv) const {
    auto texel = [](float u, int n) {
        float x = u * static_cast<float>(n);
        // The comparison also catches NaN.
        return x > 0 ? std::min(static_cast<int>(std::min(x, static_cast<float>(n))), n - 1) : 0;
    };
    return {texel(uv.x, size_.x), texel(uv.y, size_.y)};
}

std::optional<Image> load_emission_image(const Node& node, const std::string& filename,
                                         std::string_view owner, BuildContext& context) {
    const Place& place = node.place_of("filename");
    try {
        Image image = read_image(context.resolve(filename));
        std::size_t bad = count_non_finite(image);
        if (bad == 0) return image;
        context.messages.add_error(place,
                                   fmt::format("image \"{}\" of {} has {} values that are not finite; light "
                                               "must be finite",
                                               filename, owner, bad));
    } catch (const std::runtime_error& error) {
        context.messages.add_error(
            place, fmt::format("cannot read image \"{}\" of {}: {}", filename, owner, error.what()));
    }
    return std::nullopt;
}

} // namespace alhazen
