/// Light of hot matter, at temperatures that differ from place to place.
#pragma once

#include <vector>

#include "color/wavelengths.h"

namespace alhazen {

/// Planck's law with its maximum at 1, in the units of pbrt-v4's film (see SpectrumValue::light_scale): not
/// normalised to a luminance, so that hotter is whiter and not brighter.
class Glow {
  public:
    explicit Glow(ColorMode mode);
    /// kelvin at least coldest, else black: nobody sees it.
    Spectrum eval(float kelvin, const Wavelengths& lambda) const;

    static constexpr float coldest = 100;

  private:
    std::vector<Spectrum> rgb_; ///< at temperatures that grow by the same factor, in RGB mode
};

} // namespace alhazen
