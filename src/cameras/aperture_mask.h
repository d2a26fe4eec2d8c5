/// What an aperture stop lets through where it is not a round hole: a picture over the square around the
/// stop.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "image/image.h"

namespace alhazen {

class ApertureMask {
  public:
    /// The grey value of each pixel; its upper edge is up. The mean is made that of the square's round hole,
    /// so that shapes do not change the exposure, as in pbrt. Throws std::runtime_error when it lets no light
    /// through, or a value is negative or not finite.
    explicit ApertureMask(const Image& image);
    /// pbrt's shapes gaussian, square, pentagon and star; nullopt for other names.
    static std::optional<ApertureMask> named(std::string_view name);

    /// What passes at a place, in radii of the stop, which has x to the right and y up; interpolated.
    double at(Vec2d place) const;
    /// How far from the centre light may pass, in radii of the stop.
    double reach() const { return reach_; }

  private:
    double pixel(int x, int y) const;

    int width_ = 0, height_ = 0;
    std::vector<float> values_;
    double reach_ = 0;
};

} // namespace alhazen
