#include "textures/texels.h"

#include "image/image_colors.h"
#include "textures/tiled_pyramid.h"

namespace alhazen {

namespace {

// The same value at all wavelengths.
template <class Texels>
struct GreyTexels final : ColorTexels {
    Texels texels;
    SpectrumValue one;

    GreyTexels(Texels t, SpectrumRole role) : texels(std::move(t)), one(SpectrumValue::constant(1, role)) {}
    Spectrum lookup(const TexelPlace& at, const Wavelengths& lambda) const override {
        return look_up(texels, at, [](float v) { return Spectrum(v); }) * one.eval(lambda);
    }
    std::size_t bytes() const override { return texels.bytes(); }
};

template <class Texels>
struct RgbTexels final : ColorTexels {
    Texels texels;

    explicit RgbTexels(Texels t) : texels(std::move(t)) {}
    Spectrum lookup(const TexelPlace& at, const Wavelengths&) const override {
        return look_up(texels, at,
                       [](Vec3 c) { return Spectrum(c.x, c.y, c.z, (c.x + c.y + c.z) * (1.0f / 3)); });
    }
    std::size_t bytes() const override { return texels.bytes(); }
};

template <class Texels>
struct AlbedoTexels final : ColorTexels {
    Texels texels;

    explicit AlbedoTexels(Texels t) : texels(std::move(t)) {}
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

template <class Texels>
struct ScaledTexels final : ColorTexels {
    Texels texels;
    const SpectralCurve* illuminant; ///< white's light; nullptr for quantities that are not light

    ScaledTexels(Texels t, const SpectralCurve* white) : texels(std::move(t)), illuminant(white) {}
    Spectrum lookup(const TexelPlace& at, const Wavelengths& lambda) const override {
        Spectrum value = look_up(
            texels, at, [&](const ScaledSigmoid& t) { return t.sigmoid.eval(lambda.lambda) * t.scale; });
        return illuminant ? value * illuminant->eval(lambda.lambda) : value;
    }
    std::size_t bytes() const override { return texels.bytes(); }
};

template <class Texels>
struct NumberTexels final : FloatTexels {
    Texels texels;

    explicit NumberTexels(Texels t) : texels(std::move(t)) {}
    float lookup(const TexelPlace& at) const override {
        return look_up(texels, at, [](float v) { return v; });
    }
    std::size_t bytes() const override { return texels.bytes(); }
};

bool has_transparency(const Image& image, int alpha) {
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            if (image.at(x, y, alpha) != 1) return true;
    return false;
}

Image one_channel(const Image& image, int channel) {
    return image.select({&image.channel_names()[static_cast<std::size_t>(channel)], 1});
}

// Linear values as a texture has them.
struct Adjustment {
    TexelAdjustment adjust;
    bool is_albedo;

    float operator()(float v) const { return is_albedo ? std::min(1.0f, adjust(v)) : adjust(v); }
    Vec3 operator()(Vec3 c) const { return {(*this)(c.x), (*this)(c.y), (*this)(c.z)}; }
};

std::vector<Vec3> adjusted_rows(const Image& image, int first, int last, const Adjustment& adjusted) {
    std::vector<Vec3> colors;
    colors.reserve(static_cast<std::size_t>(last - first) * static_cast<std::size_t>(image.width()));
    for (int y = first; y < last; ++y)
        for (int x = 0; x < image.width(); ++x) colors.push_back(adjusted(image.rgb(x, y)));
    return colors;
}

FillRows<Vec3> fill_rgb(const RgbColorSpace& space, Adjustment adjusted) {
    if (&space == &srgb_space())
        return fill_each<Vec3>([=](const Image& level, int x, int y) { return adjusted(level.rgb(x, y)); });
    return fill_each<Vec3>(
        [adjusted, to_srgb = convert_rgb(space, srgb_space())](const Image& level, int x, int y) {
            return max(to_srgb * adjusted(level.rgb(x, y)), Vec3(0));
        });
}

FillRows<SigmoidCoefficients> fill_albedos(const PictureUpsampler& upsampled, Adjustment adjusted) {
    return
        [&upsampled, adjusted](const Image& level, int first, int last, std::span<SigmoidCoefficients> out) {
            upsampled(adjusted_rows(level, first, last, adjusted), out);
        };
}

FillRows<ScaledSigmoid> fill_scaled(const PictureUpsampler& upsampled, Adjustment adjusted) {
    return [&upsampled, adjusted](const Image& level, int first, int last, std::span<ScaledSigmoid> out) {
        std::vector<Vec3> normalized = adjusted_rows(level, first, last, adjusted);
        for (std::size_t i = 0; i < out.size(); ++i) {
            Vec3& c = normalized[i];
            out[i].scale = 2 * max_component(c);
            c = out[i].scale > 0 ? c / out[i].scale : Vec3(0);
        }
        std::vector<SigmoidCoefficients> sigmoids(out.size());
        upsampled(normalized, sigmoids);
        for (std::size_t i = 0; i < out.size(); ++i) out[i].sigmoid = sigmoids[i];
    };
}

const auto fill_numbers = fill_each<float>([](const Image& level, int x, int y) { return level.at(x, y); });

} // namespace

// The texels, in the class of textures that has them.
template <class Kept, template <class> class Kind, class T, class... More>
std::shared_ptr<const Kept> TexelMaker::keep(Image image, WrapMode wrap, const FillRows<T>& fill,
                                             const More&... more) const {
    if (tiles_)
        return std::make_shared<Kind<TiledPyramid<T>>>(TiledPyramid<T>(std::move(image), wrap, fill, tiles_),
                                                       more...);
    return std::make_shared<Kind<Pyramid<T>>>(make_pyramid<T>(std::move(image), wrap, true, fill), more...);
}

const PictureUpsampler& TexelMaker::upsampler(const RgbColorSpace& space) {
    std::lock_guard lock(mutex_);
    return upsamplers_.try_emplace(&space, space).first->second;
}

std::shared_ptr<const ColorTexels> TexelMaker::colors(const Image& image, WrapMode wrap,
                                                      TexelAdjustment adjust, SpectrumRole role,
                                                      ColorMode mode) {
    const Adjustment adjusted{adjust, role == SpectrumRole::albedo};
    if (!image.has_rgb()) {
        const auto fill =
            fill_each<float>([=](const Image& level, int x, int y) { return adjusted(level.at(x, y)); });
        return keep<ColorTexels, GreyTexels>(one_channel(image, 0), wrap, fill, role);
    }
    const RgbColorSpace& space = color_space_of(image);
    if (mode == ColorMode::rgb)
        return keep<ColorTexels, RgbTexels>(image.to_rgb(), wrap, fill_rgb(space, adjusted));
    if (adjusted.is_albedo)
        return keep<ColorTexels, AlbedoTexels>(image.to_rgb(), wrap,
                                               fill_albedos(upsampler(space), adjusted));
    const SpectralCurve* white = role == SpectrumRole::illuminant ? space.illuminant : nullptr;
    return keep<ColorTexels, ScaledTexels>(image.to_rgb(), wrap, fill_scaled(upsampler(space), adjusted),
                                           white);
}

std::shared_ptr<const FloatTexels> TexelMaker::numbers(const Image& image, WrapMode wrap) {
    if (auto alpha = image.channel_index("A"); alpha && image.has_rgb() && has_transparency(image, *alpha)) {
        // As pbrt-v4, for which alpha is encoded like the colours beside it.
        const bool is_encoded = image.info.bits == 8 || image.info.bits == 16;
        const auto fill =
            fill_each<float>([=, encoding = image.info.encoding](const Image& level, int x, int y) {
                return is_encoded ? encoding.decode(level.at(x, y)) : level.at(x, y);
            });
        return keep<FloatTexels, NumberTexels>(one_channel(image, *alpha), wrap, fill);
    }
    if (!image.has_rgb()) return keep<FloatTexels, NumberTexels>(one_channel(image, 0), wrap, fill_numbers);
    const auto mean = fill_each<float>([](const Image& level, int x, int y) {
        const Vec3 c = level.rgb(x, y);
        return (c.x + c.y + c.z) * (1.0f / 3);
    });
    return keep<FloatTexels, NumberTexels>(image.to_rgb(), wrap, mean);
}

} // namespace alhazen
