/// The one type for any colour parameter at run time: however the scene gave it (RGB, samples, a name, a
/// black body), it is evaluated at the wavelengths of a path.
#pragma once

#include <cstdint>
#include <memory>

#include "base/vec.h"
#include "color/color_space.h"
#include "color/spectral.h"
#include "color/upsample.h"
#include "color/wavelengths.h"

namespace alhazen {

/// What a colour is for, which decides how RGB becomes a spectrum and a spectrum becomes RGB.
enum class SpectrumRole : std::uint8_t {
    albedo,     ///< a fraction in 0 ... 1
    unbounded,  ///< a number >= 0: index of refraction, absorption per length ...
    illuminant, ///< light: RGB white is the colour space's illuminant
};

/// A small value with cheap copies and evaluation.
///
/// In spectral mode, eval gives: an albedo's RGB as its upsampled spectrum; unbounded RGB as that of rgb / 2m
/// times 2m, m the largest component; an illuminant's RGB as the latter times the colour space's illuminant;
/// a curve as it is (pbrt-v4's spectra).
///
/// In RGB mode, eval gives linear sRGB in lanes 0 to 2 and their mean in lane 3: RGB converted to sRGB's
/// primaries; a curve that is an albedo or unbounded as its colour under D65, so that the constant 1 is (1,
/// 1, 1); a curve that is an illuminant as its XYZ divided by cie_y_integral. Of a colour outside
/// sRGB's gamut, light has negative lanes, which the film turns into the positive ones of a wider space; what
/// light is multiplied by (an albedo, an index) is clipped at 0 instead, since it would make light negative.
/// The lanes of light that is not black always have a positive sum.
class SpectrumValue {
  public:
    /// Black.
    SpectrumValue() = default;
    /// The same at all wavelengths. As an illuminant it is the equal-energy white, as pbrt-v4's constant
    /// spectra.
    static SpectrumValue constant(float value, SpectrumRole role = SpectrumRole::unbounded);
    /// Components are clamped to [0, 1].
    static SpectrumValue albedo_rgb(const RgbColorSpace& space, Vec3 rgb);
    /// Components are clamped to >= 0.
    static SpectrumValue unbounded_rgb(const RgbColorSpace& space, Vec3 rgb);
    /// Components are clamped to >= 0. The space must be one of the named ones (its illuminant is referred
    /// to).
    static SpectrumValue illuminant_rgb(const RgbColorSpace& space, Vec3 rgb);
    /// The one of the three that the role asks for.
    static SpectrumValue rgb(const RgbColorSpace& space, Vec3 rgb, SpectrumRole role);
    /// curve must not be null.
    static SpectrumValue curve(std::shared_ptr<const SpectralCurve> curve, SpectrumRole role);
    /// A curve that outlives this value (a named one).
    static SpectrumValue curve(const SpectralCurve& curve, SpectrumRole role);
    /// Planck's law with maximum 1; kelvin > 0.
    static SpectrumValue blackbody(float kelvin, SpectrumRole role = SpectrumRole::illuminant);

    Spectrum eval(const Wavelengths& wavelengths) const {
        return wavelengths.mode == ColorMode::rgb ? rgb_lanes_ : scale_ * eval_spectral(wavelengths.lambda);
    }
    /// The value in RGB mode.
    Vec3 linear_srgb() const { return {rgb_lanes_[0], rgb_lanes_[1], rgb_lanes_[2]}; }
    SpectrumRole role() const { return role_; }
    /// An upper bound of eval in both modes.
    float max_value() const;
    /// True when eval is the same number at all wavelengths (and, but for illuminants, in all RGB lanes).
    bool is_constant() const { return kind_ == Kind::constant; }
    bool is_black() const { return scale_ == 0; }
    /// This value times s >= 0.
    SpectrumValue scaled(float s) const;

    /// The y_integral of the spectrum; for an RGB illuminant, of the illuminant alone (pbrt-v4's
    /// SpectrumToPhotometric, by which its lights divide).
    float photometric() const;
    /// What a light must multiply its value by, besides its own scale, for its picture to come out in the
    /// units of pbrt-v4: an RGB light of (r, g, b) shows as (r, g, b) on the film, a spectrum with Y = 1.
    /// Since the sensor integrates without dividing by cie_y_integral, that is 1 / photometric() in spectral
    /// mode; RGB mode's values have been divided, hence cie_y_integral / photometric() there. 0 when the
    /// spectrum has no visible part.
    float light_scale(ColorMode mode) const;

  private:
    enum class Kind : std::uint8_t { constant, sigmoid, illuminant, curve };

    Spectrum eval_spectral(Spectrum lambda) const;

    Spectrum rgb_lanes_{0};                      ///< RGB mode's value, scale included
    std::shared_ptr<const SpectralCurve> curve_; ///< the curve, or the RGB illuminant's white
    SigmoidCoefficients sigmoid_;
    float scale_ = 0;
    Kind kind_ = Kind::constant;
    SpectrumRole role_ = SpectrumRole::unbounded;
};

} // namespace alhazen
