/// What the red, green and blue pixels of digital cameras answer to light of each wavelength, and the matrix
/// that makes XYZ of their answers: no camera is a linear function of the eye, so it is the one that fits the
/// swatches of a colour chart best (Pharr et al. 2023, section 5.4.2; Langlands and Fascione 2020,
/// "PhysLight").
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "color/matrix3.h"
#include "color/spectral.h"

namespace alhazen {

struct CameraCurves {
    static constexpr int lambda_first = 380, lambda_step = 10; ///< nm
    static constexpr std::size_t count = 35;

    std::string_view name;            ///< pbrt-v4's
    std::array<float, 3 * count> rgb; ///< red, green and blue at 380 nm, at 390 nm ...; green is 1 at 520 nm

    /// Red, green and blue as x, y and z at four wavelengths: linear between the samples, 0 outside.
    ObserverSample sample(Spectrum lambda) const;
    /// Red (0), green (1) or blue (2) as a curve.
    SpectralCurve curve(std::size_t channel) const;
};

/// All cameras, sorted by name.
std::span<const CameraCurves> all_camera_curves();
/// nullptr when there is none of this name.
const CameraCurves* find_camera_curves(std::string_view name);

/// Reflectances of the ColorChecker's 24 swatches, from "dark skin" to "black".
const std::vector<SpectralCurve>& color_checker();

/// XYZ of the camera's channels, each the integral over nm of curve and radiance: the matrix of least squared
/// error over the color_checker. What it makes of a swatch under scene_light are the swatch's own XYZ under
/// output_light, times the luminance of scene_light, so that white balance is included. nullopt when the
/// light is too dark or too narrow for the camera to tell colours.
std::optional<Matrix3> xyz_from_camera(const CameraCurves& camera, const SpectralCurve& scene_light,
                                       const SpectralCurve& output_light);

} // namespace alhazen
