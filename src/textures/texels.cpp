#include "textures/texels.h"

#include "image/image_colors.h"

namespace alhazen {

namespace {

// The same value at all wavelengths.
struct GreyTexels final : ColorTexels {
    Pyramid<float> texels;
    SpectrumValue one;

    Spectrum lookup(const TexelPlace& at, const Wavelengths& lambda) const override {
        return look_up(texels, at, [](float v) { return Spectrum(v); }) * one.eval(lambda);
    }
    std::size_t bytes() const override { return texels.bytes(); }
};

struct RgbTexels final : ColorTexels {
    Pyramid<Vec3> texels;

    Spectrum lookup(const TexelPlace& at, const Wavelengths&) const override {
        return look_up(texels, at,
                       [](Vec3 c) { return Spectrum(c.x, c.y, c.z, (c.x + c.y + c.z) * (1.0f / 3)); });
    }
    std::size_t bytes() const override { return texels.bytes(); }
};

struct AlbedoTexels final : ColorTexels {
    Pyramid<SigmoidCoefficients> texels;

    Spectrum lookup(const TexelPlace& at, const Wavelengths& lambda) const override {
        return look_up(texels, at, [&](const SigmoidCoefficients& c) { return c.eval(lambda.lambda); });
    }
    std::size_t bytes() const override { return texels.bytes(); }
};

// A colour of any size: the sigmoid of rgb / scale, times scale = 2 max(rgb), so that the sigmoid stays away
// from its ends (Pharr et al. 2023, section 4.6.6).
struct ScaledSigmoid {
    SigmoidCoefficients sigmoid;
    float scale = 0;
};

struct ScaledTexels final : ColorTexels {
    Pyramid<ScaledSigmoid> texels;
    const SpectralCurve* illuminant = nullptr; ///< white's light; nullptr for quantities that are not light

    Spectrum lookup(const TexelPlace& at, const Wavelengths& lambda) const override {
        Spectrum value = look_up(
            texels, at, [&](const ScaledSigmoid& t) { return t.sigmoid.eval(lambda.lambda) * t.scale; });
        return illuminant ? value * illuminant->eval(lambda.lambda) : value;
    }
    std::size_t bytes() const override { return texels.bytes(); }
};

std::vector<SigmoidCoefficients> upsample_all(const RgbColorSpace& space, const std::vector<Vec3>& colors) {
    std::vector<SigmoidCoefficients> out(colors.size());
    upsample(space, colors, out);
    return out;
}

Pyramid<SigmoidCoefficients> upsample_albedos(const RgbColorSpace& space, const Pyramid<Vec3>& colors) {
    std::vector<Pyramid<SigmoidCoefficients>::Level> levels;
    for (int l = 0; l < colors.levels(); ++l)
        levels.push_back({colors.size(l), upsample_all(space, colors.level(l).texels)});
    return {std::move(levels), colors.wrap_mode()};
}

Pyramid<ScaledSigmoid> upsample_scaled(const RgbColorSpace& space, const Pyramid<Vec3>& colors) {
    std::vector<Pyramid<ScaledSigmoid>::Level> levels;
    for (int l = 0; l < colors.levels(); ++l) {
        std::vector<Vec3> normalized = colors.level(l).texels;
        std::vector<float> scales;
        scales.reserve(normalized.size());
        for (Vec3& c : normalized) {
            float scale = 2 * max_component(c);
            c = scale > 0 ? c / scale : Vec3(0);
            scales.push_back(scale);
        }
        auto sigmoids = upsample_all(space, normalized);
        std::vector<ScaledSigmoid> texels(scales.size());
        for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = {sigmoids[i], scales[i]};
        levels.push_back({colors.size(l), std::move(texels)});
    }
    return {std::move(levels), colors.wrap_mode()};
}

bool has_transparency(const Image& image, int alpha) {
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            if (image.at(x, y, alpha) != 1) return true;
    return false;
}

} // namespace

std::unique_ptr<ColorTexels> make_color_texels(const Image& image, WrapMode wrap, TexelAdjustment adjust,
                                               SpectrumRole role, ColorMode mode) {
    bool is_albedo = role == SpectrumRole::albedo;
    auto adjusted = [&](float v) { return is_albedo ? std::min(1.0f, adjust(v)) : adjust(v); };
    if (!image.has_rgb()) {
        auto grey = std::make_unique<GreyTexels>();
        grey->texels = channel_pyramid(image, 0, wrap).map(adjusted);
        grey->one = SpectrumValue::constant(1, role);
        return grey;
    }
    Pyramid<Vec3> colors = rgb_pyramid(image, wrap).map([&](Vec3 c) {
        return Vec3(adjusted(c.x), adjusted(c.y), adjusted(c.z));
    });
    const RgbColorSpace& space = color_space_of(image);
    if (mode == ColorMode::rgb) {
        auto rgb = std::make_unique<RgbTexels>();
        rgb->texels = &space == &srgb_space() ? std::move(colors) : colors.map([&](Vec3 c) {
            return max(convert_rgb(space, srgb_space()) * c, Vec3(0));
        });
        return rgb;
    }
    if (is_albedo) {
        auto albedo = std::make_unique<AlbedoTexels>();
        albedo->texels = upsample_albedos(space, colors);
        return albedo;
    }
    auto scaled = std::make_unique<ScaledTexels>();
    scaled->texels = upsample_scaled(space, colors);
    if (role == SpectrumRole::illuminant) scaled->illuminant = space.illuminant;
    return scaled;
}

Pyramid<float> make_float_texels(const Image& image, WrapMode wrap) {
    if (auto alpha = image.channel_index("A");
        alpha && image.channels() > 1 && has_transparency(image, *alpha))
        return channel_pyramid(image, *alpha, wrap);
    if (!image.has_rgb()) return channel_pyramid(image, 0, wrap);
    return rgb_pyramid(image, wrap).map([](Vec3 c) { return (c.x + c.y + c.z) * (1.0f / 3); });
}

} // namespace alhazen
