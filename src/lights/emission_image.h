/// A picture whose pixels are lights: the texels of environment maps and of glowing screens, each ready to be
/// evaluated at a path's wavelengths. In RGB mode a texel is its colour, in spectral mode a smooth spectrum
/// (Jakob and Hanika 2019) that is fitted once, when the image is loaded.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "color/spectrum_value.h"
#include "describe/scene_description.h"
#include "image/image.h"

namespace alhazen {

struct BuildContext;

class EmissionImage {
  public:
    /// Negative values count as 0, in the image's colour space.
    EmissionImage(const Image& image, ColorMode mode);

    Vec2i size() const { return size_; }
    /// The texel's light. Times light_scale() it is what pbrt-v4 shows.
    Spectrum eval(Vec2i texel, const Wavelengths& lambda) const;
    /// SpectrumValue's light_scale for all of the image.
    float light_scale() const { return light_scale_; }
    /// The light at a point of the unit square, (0, 0) being the upper left corner, blended between the
    /// middles of texels; points outside are moved to the border.
    Spectrum bilinear(Vec2 uv, const Wavelengths& lambda) const;
    /// The texel at a point of the unit square.
    Vec2i nearest(Vec2 uv) const;

  private:
    struct Texel {
        float c[3] = {0, 0, 0}; ///< RGB mode: red, green, blue; spectral mode: a sigmoid ...
        float scale = 0;        ///< ... and what it is multiplied by
    };
    void fill(const Image& image, std::size_t first, std::size_t last, ColorMode mode);

    const RgbColorSpace* space_;
    Vec2i size_;
    float light_scale_ = 1;
    std::vector<Texel> texels_;
};

/// The image that the parameter "filename" of a light's node names. nullopt with an error added when it
/// cannot be read or has values that are not finite; owner is as in read_fields.
std::optional<Image> load_emission_image(const Node& node, const std::string& filename,
                                         std::string_view owner, BuildContext& context);

/// A pixel's colour with negative values taken for 0.
inline Vec3 emitted_rgb(const Image& image, int x, int y) {
    return max(image.rgb(x, y), Vec3(0));
}

} // namespace alhazen
