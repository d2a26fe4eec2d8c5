/// From RGB to smooth spectra: three numbers become the coefficients of a polynomial in the wavelength,
/// squashed into 0 ... 1 by a sigmoid (Jakob and Hanika 2019, "A low-dimensional function space for efficient
/// spectral upsampling").
#pragma once

#include <span>

#include "base/vec.h"
#include "color/color_space.h"
#include "color/spectrum.h"

namespace alhazen {

/// s(c0 t^2 + c1 t + c2), s(x) = 1/2 + x / (2 sqrt(1 + x^2)), where t = (lambda - 595 nm) / 235 nm, so that t
/// runs from -1 to 1 over the visible range. (The paper's polynomial is in nm; this is better conditioned.)
struct SigmoidCoefficients {
    float c0 = 0, c1 = 0, c2 = 0;

    /// Values in [0, 1] at wavelengths in nm.
    Spectrum eval(Spectrum lambda) const {
        Spectrum t = (lambda - 595.0f) * (1 / 235.0f);
        Spectrum x = (c0 * t + c1) * t + c2;
        return 0.5f + 0.5f * x / sqrt(1.0f + x * x);
    }
    float eval(float lambda) const;
    /// The maximum over lambda_min ... lambda_max.
    float max_value() const;

    /// The flat spectrum of the given value, clamped to [0, 1]; 0 and 1 come out exact.
    static SigmoidCoefficients grey(float value);
};

/// The spectrum whose colour is rgb under the space's illuminant; components are clamped to [0, 1]. Where no
/// such spectrum exists (saturated colours of wide spaces), the nearest in CIE Lab that was found. The first
/// call for a space fits its table of starting points, which takes tens of milliseconds. Thread-safe and
/// deterministic.
SigmoidCoefficients upsample(const RgbColorSpace& space, Vec3 rgb);
/// Of the upsampling of many colours at once: the largest difference, in any component of linear sRGB,
/// between a colour and that of its spectrum, above what the upsampling of that colour alone leaves.
inline constexpr double upsample_error = 1e-4;

/// The same for many colours at once, on the threads of the enclosing with_threads, to within upsample_error:
/// several times faster. Each result depends on its own colour only. out must be as long as rgb.
void upsample(const RgbColorSpace& space, std::span<const Vec3> rgb, std::span<SigmoidCoefficients> out);

} // namespace alhazen
