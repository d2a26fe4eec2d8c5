/// An image prepared for lookups: every texel is turned, once, into what is cheap to evaluate at a path's
/// wavelengths. The four texels of a bilinear lookup are evaluated before they are interpolated, so that the
/// blend of two colours is the blend of their spectra, whatever the colours.
#pragma once

#include <memory>

#include "color/spectrum_value.h"
#include "image/pyramid.h"

namespace alhazen {

/// How texels between pixel centres are found.
enum class TexelFilter { point, bilinear, trilinear, ewa };

/// Linear values before they are used: scaled, then inverted, then cut off below 0.
struct TexelAdjustment {
    float scale = 1;
    bool invert = false;

    float operator()(float v) const { return std::max(0.0f, invert ? 1 - scale * v : scale * v); }
};

/// Colours of an image.
struct ColorTexels {
    virtual ~ColorTexels() = default;
    /// st: as in image/pyramid.h, (0, 0) the upper left corner. Filters other than point are bilinear.
    virtual Spectrum lookup(Vec2 st, TexelFilter filter, const Wavelengths& lambda) const = 0;
    virtual std::size_t bytes() const = 0;
};

/// In spectral mode sigmoid coefficients of the upsampled colours (Jakob and Hanika 2019), in RGB mode linear
/// sRGB. An image of one channel gives the same value at all wavelengths, whatever the role (as pbrt-v4).
std::unique_ptr<ColorTexels> make_color_texels(const Image& image, WrapMode wrap, TexelAdjustment adjustment,
                                               SpectrumRole role, ColorMode mode);

/// Numbers of an image: its only channel; else its alpha where that is not 1 everywhere; else the mean of its
/// colour (as pbrt-v4).
Pyramid<float> make_float_texels(const Image& image, WrapMode wrap);

} // namespace alhazen
