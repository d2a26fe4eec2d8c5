/// The sky as a picture: which direction each pixel of an environment map stands for, what arrives from
/// there, and how to draw directions in proportion to it (Pharr et al. 2023, section 12.5.2). Light is
/// constant over each pixel, and so is the density per steradian, so that the drawn light over its density
/// hardly varies.
#pragma once

#include <functional>

#include "lights/emission_image.h"
#include "math/distribution.h"

namespace alhazen {

/// Directions are unit vectors in the light's own space, z upwards.
class EnvironmentMap {
  public:
    /// Square images are equal-area octahedral maps (Clarberg 2008), as in pbrt-v4. Those twice as wide as
    /// high are equirectangular: columns from longitude 0 (+x) by +y once around, rows from +z down to -z.
    static bool is_valid_size(Vec2i size) { return size.x == size.y || size.x == 2 * size.y; }
    /// The size must be valid.
    EnvironmentMap(const Image& image, ColorMode mode);

    /// Which directions are drawn: all in proportion to their light; or, for those who also draw directions
    /// in other ways, what is brighter than the mean in proportion to how much brighter it is (Karlik et al.
    /// 2019).
    enum class Draw { all, bright };
    struct Sample {
        Vec3 w;
        float pdf = 0; ///< per steradian
        Vec2i texel;
    };
    Sample sample(Vec2 u, Draw draw) const;
    /// Density per steradian with which sample() draws w.
    float pdf(Vec3 w, Draw draw) const { return pdf(texel_of(w), draw); }
    Vec2i texel_of(Vec3 w) const;
    /// Light from the texel, not yet calibrated (see EmissionImage).
    Spectrum eval(Vec2i texel, const Wavelengths& lambda) const { return texels_.eval(texel, lambda); }
    float light_scale() const { return texels_.light_scale(); }

    /// Linear sRGB, mean over all directions.
    Vec3 mean_rgb() const { return mean_rgb_; }
    /// Luminance times cosine, integrated over the upper half (z > 0).
    float illuminance() const { return illuminance_; }

  private:
    bool is_octahedral() const { return texels_.size().x == texels_.size().y; }
    float solid_angle(int row) const;
    Vec3 direction(Vec2 uv) const;
    float pdf(Vec2i texel, Draw draw) const;
    void integrate(const Image& image);
    PiecewiseConstant2D make_distribution(const Image& image, Draw draw) const;
    const PiecewiseConstant2D& distribution(Draw draw) const { return draw == Draw::all ? all_ : bright_; }

    EmissionImage texels_;
    Vec3 mean_rgb_;
    float illuminance_ = 0;
    PiecewiseConstant2D all_, bright_;
};

/// The colours of the image (linear, in its own colour space) as a function of the direction, blended between
/// its pixels. The size must be valid for an EnvironmentMap.
std::function<Vec3(Vec3)> blended_sky(const Image& image);

} // namespace alhazen
