/// An image prepared for lookups: every texel is turned, once, into what is cheap to evaluate at a path's
/// wavelengths. The four texels of a bilinear lookup are evaluated before they are interpolated, so that the
/// blend of two colours is the blend of their spectra, whatever the colours.
#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "color/spectrum_value.h"
#include "color/upsample_many.h"
#include "image/make_pyramid.h"
#include "textures/tile_cache.h"

namespace alhazen {

/// How texels between pixel centres are found.
enum class TexelFilter { point, bilinear, trilinear, ewa };

/// Where texels are looked up, and over how much.
struct TexelPlace {
    Vec2 st;   ///< as in image/pyramid.h, (0, 0) the upper left corner
    Vec2 a, b; ///< axes of the ellipse that a pixel covers; zero: a point
    TexelFilter filter = TexelFilter::bilinear;
    float max_anisotropy = 8;
};

/// The value there: by one of the levels, or two, whose texels are about as large as the pixel (as pbrt-v4).
template <class Texels, class Evaluate>
auto look_up(const Texels& texels, const TexelPlace& at, Evaluate evaluate) {
    if (at.filter == TexelFilter::ewa) return texels.ewa(at.st, at.a, at.b, at.max_anisotropy, evaluate);
    const float width =
        2 * std::max({std::abs(at.a.x), std::abs(at.a.y), std::abs(at.b.x), std::abs(at.b.y)});
    if (at.filter == TexelFilter::trilinear) return texels.trilinear(at.st, width, evaluate);
    const int level = static_cast<int>(texels.continuous_level(width));
    if (at.filter == TexelFilter::bilinear) return texels.bilinear(level, at.st, evaluate);
    const auto texel = nearest_texel(texels.wrap_mode(), at.st, texels.size(level));
    using Value = std::decay_t<decltype(evaluate(texels.level(level).at(Vec2i{})))>;
    return texel ? evaluate(texels.level(level).at(*texel)) : Value(0);
}

/// Linear values before they are used: scaled, then inverted, then cut off below 0.
struct TexelAdjustment {
    float scale = 1;
    bool invert = false;

    float operator()(float v) const { return std::max(0.0f, invert ? 1 - scale * v : scale * v); }
};

/// Colours of an image.
struct ColorTexels {
    virtual ~ColorTexels() = default;
    virtual Spectrum lookup(const TexelPlace& at, const Wavelengths& lambda) const = 0;
    virtual std::size_t bytes() const = 0;
};

/// Numbers of an image.
struct FloatTexels {
    virtual ~FloatTexels() = default;
    virtual float lookup(const TexelPlace& at) const = 0;
    virtual std::size_t bytes() const = 0;
};

/// Makes texels of the images of one scene. May be used from several threads.
class TexelMaker {
  public:
    /// Keeps the texels that are made from now on in these tiles, instead of in memory.
    void keep_in(std::shared_ptr<TileCache> tiles) { tiles_ = std::move(tiles); }
    /// In spectral mode sigmoid coefficients of the upsampled colours (Jakob and Hanika 2019), in RGB mode
    /// linear sRGB. An image of one channel gives the same value at all wavelengths, whatever the role (as
    /// pbrt-v4).
    std::shared_ptr<const ColorTexels> colors(const Image& image, WrapMode wrap, TexelAdjustment adjust,
                                              SpectrumRole role, ColorMode mode);
    /// The only channel; else alpha where that is not 1 everywhere; else the mean of the colour (as pbrt-v4).
    std::shared_ptr<const FloatTexels> numbers(const Image& image, WrapMode wrap);

  private:
    const PictureUpsampler& upsampler(const RgbColorSpace& space);
    template <class Kept, template <class> class Kind, class T, class... More>
    std::shared_ptr<const Kept> keep(Image image, WrapMode wrap, const FillRows<T>& fill,
                                     const More&... more) const;

    std::shared_ptr<TileCache> tiles_;
    std::mutex mutex_;
    std::map<const RgbColorSpace*, PictureUpsampler> upsamplers_;
};

} // namespace alhazen
