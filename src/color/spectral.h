/// Spectra of scene data: what a light emits or a metal's index is at each wavelength, as a curve through
/// samples. Includes the CIE 1931 observer, the standard illuminants, and measured metals and glasses under
/// pbrt-v4's names.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/vec.h"
#include "color/spectrum.h"
#include "color/wavelengths.h"

namespace alhazen {

/// A function of the wavelength in nm, linear between its samples and 0 outside them. Immutable.
class SpectralCurve {
  public:
    /// The same value at every wavelength.
    static SpectralCurve constant(float value);
    /// Through (lambdas[i], values[i]). Throws std::invalid_argument, saying what is wrong, when the counts
    /// differ or are less than 2, a number is not finite, a wavelength is not positive, or the wavelengths do
    /// not increase.
    static SpectralCurve from_samples(std::span<const float> lambdas, std::span<const float> values);
    /// As from_samples for lambda0 value0 lambda1 value1 ..., as the scene language writes them.
    static SpectralCurve from_pairs(std::span<const float> pairs);
    /// As from_pairs for a spectrum file's text: numbers divided by white space, '#' begins a comment.
    static SpectralCurve parse(std::string_view text);
    /// Samples at start, start + step, ...; step > 0.
    static SpectralCurve uniform(float start, float step, std::vector<float> values);
    /// Planck's law scaled so that its maximum over all wavelengths is 1 (as pbrt-v4); kelvin > 0.
    static SpectralCurve blackbody(float kelvin);
    /// The CIE daylight illuminant of a colour temperature, scaled so that its y_integral is cie_y_integral;
    /// below 4000 K, where daylight is not defined, the black body (CIE 15:2004, section 3.1; pbrt-v4 does
    /// the same).
    static SpectralCurve daylight(float kelvin);

    float eval(float lambda) const;
    Spectrum eval(Spectrum lambdas) const;
    float max_value() const { return max_; }
    bool is_constant() const { return constant_; }
    /// This curve times s.
    SpectralCurve scaled(float s) const;
    /// The same curve with its first and last value kept on to lambda_min and lambda_max.
    SpectralCurve extended() const;

  private:
    SpectralCurve() = default;
    void find_max();

    std::vector<float> lambdas_; ///< empty when the samples are evenly spaced
    std::vector<float> values_;
    float start_ = 0, inverse_step_ = 0;
    float max_ = 0;
    bool constant_ = false;
};

/// Planck's law: radiance in W / (m^2 sr m) of a black body at lambda (nm) and kelvin; 0 for kelvin <= 0.
double blackbody_radiance(double lambda, double kelvin);

/// The CIE 1931 2-degree colour matching functions, 360 to 830 nm in steps of 1 nm.
const SpectralCurve& cie_x();
const SpectralCurve& cie_y();
const SpectralCurve& cie_z();
/// The sum of cie_y over its samples.
inline constexpr float cie_y_integral = 106.856895f;

/// x, y and z of the observer at four wavelengths; 0 outside the range.
struct ObserverSample {
    Spectrum x, y, z;
};
ObserverSample sample_observer(Spectrum lambda);

/// Sums over each whole nm of the curve times cie_x, cie_y, cie_z. Divide by cie_y_integral for the
/// tristimulus of which the constant 1 has Y = 1.
Vec3d cie_integrals(const SpectralCurve& curve);
/// The sum over each whole nm of the curve times cie_y.
double y_integral(const SpectralCurve& curve);

/// A spectrum by pbrt-v4's name ("stdillum-D65", "metal-Cu-eta", "glass-BK7" ...), nullptr when there is
/// none. Illuminants are scaled so that their y_integral is cie_y_integral. The curve lives as long as the
/// program.
const SpectralCurve* named_spectrum(std::string_view name);
/// All names, sorted.
const std::vector<std::string>& spectrum_names();

} // namespace alhazen
