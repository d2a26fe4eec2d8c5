/// The sky seen through a window (Bitterli, Wyman and Pharr 2015, "Portal-masked environment map sampling").
/// The sky is redrawn on a square whose axes are angles about the window's sides. There, what the window
/// shows of it is an upright rectangle from wherever one looks, and pixels of the rectangle are drawn in
/// proportion to their light.
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "base/frame.h"
#include "lights/emission_image.h"
#include "math/windowed_distribution.h"

namespace alhazen {

/// In order round the window's edge, in world space.
using PortalCorners = std::array<Vec3, 4>;
/// Whether they are the corners of a rectangle, to within one in a thousand.
bool is_rectangle(const PortalCorners& corners);

/// Points and directions (unit vectors) are in world space. The window is looked through along its normal,
/// (corner 3 - corner 0) x (corner 1 - corner 0); from the other side nothing is seen.
class PortalMap {
  public:
    /// The corners must be those of a rectangle. sky gives the radiance from a direction in the given colour
    /// space, linear; it is asked for resolution^2 of them. Negative components count as 0.
    PortalMap(const PortalCorners& corners, int resolution, const std::function<Vec3(Vec3)>& sky,
              const RgbColorSpace& space, ColorMode mode);

    struct Sample {
        Vec3 w;
        float pdf = 0; ///< per steradian
        Vec2i texel;
    };
    /// Of what is seen from p; nullopt when that is nothing.
    std::optional<Sample> sample(Vec3 p, Vec2 u) const;
    /// Density with which sample() draws w.
    float pdf(Vec3 p, Vec3 w) const;
    /// The pixel that is seen from p in direction w; nullopt beside the window.
    std::optional<Vec2i> texel_seen(Vec3 p, Vec3 w) const;
    /// Light from the texel, not yet calibrated (see EmissionImage).
    Spectrum eval(Vec2i texel, const Wavelengths& lambda) const { return texels_->eval(texel, lambda); }
    float light_scale() const { return texels_->light_scale(); }
    /// All that can come through the window: radiance times cosine, integrated over its area and the
    /// directions in front of it; linear sRGB.
    Vec3 flux() const { return flux_; }

  private:
    using Window = WindowedPiecewiseConstant2D::Window;

    Vec3 direction(Vec2 uv) const;
    std::optional<Vec2> place_of(Vec3 w) const;
    /// Solid angle over area of the square.
    float stretch(Vec3 w) const;
    std::optional<Window> window_from(Vec3 p) const;

    Frame frame_;  ///< x and y along the window's sides
    Vec3 lo_, hi_; ///< opposite corners
    std::optional<EmissionImage> texels_;
    std::optional<WindowedPiecewiseConstant2D> distribution_;
    Vec3 flux_;
};

} // namespace alhazen
