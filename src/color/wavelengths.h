/// Which wavelengths a path carries. Four of them are drawn for each camera sample, a quarter of the density
/// apart (hero wavelength sampling, Wilkie et al. 2014).
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

#include "base/vec.h"
#include "color/spectrum.h"

namespace alhazen {

/// The meaning of a Spectrum's lanes, the same for a whole render: four sampled wavelengths, or linear sRGB
/// red, green, blue and their mean.
enum class ColorMode : std::uint8_t { spectral, rgb };

/// "spectral" or "rgb"; nullopt for any other name.
constexpr std::optional<ColorMode> find_color_mode(std::string_view name) {
    if (name == "spectral") return ColorMode::spectral;
    if (name == "rgb") return ColorMode::rgb;
    return std::nullopt;
}

/// The range of wavelengths in nm, those for which the CIE 1931 observer is tabulated.
inline constexpr float lambda_min = 360, lambda_max = 830;

/// Density (per nm) of the wavelengths that sample_visible draws; 0 outside lambda_min ... lambda_max. Found
/// so that four partners together measure red, green and blue with little error (tools/fit_wavelengths.cpp).
float visible_wavelength_pdf(float lambda);
/// The wavelength in nm below which the fraction u (0 <= u <= 1) of that density lies, and the density there.
struct VisibleWavelength {
    float lambda, pdf;
};
VisibleWavelength sample_visible_wavelength(float u);

/// The wavelengths of one path and the density each was drawn with.
struct Wavelengths {
    ColorMode mode = ColorMode::rgb;
    Spectrum lambda{0}; ///< nm; not used in RGB mode
    Spectrum pdf{1};    ///< per nm; 1 in RGB mode, 0 for terminated lanes

    /// Four partners u + i/4 (mod 1) of the visible density; 0 <= u < 1.
    static Wavelengths sample_visible(float u);
    /// Four partners of the uniform density from lo to hi (nm); 0 <= u < 1.
    static Wavelengths uniform(float u, float lo = lambda_min, float hi = lambda_max) {
        const float range = hi - lo;
        Wavelengths w{ColorMode::spectral, 0, 1 / range};
        for (int i = 0; i < 4; ++i) {
            float partner = u + 0.25f * static_cast<float>(i);
            if (partner >= 1) partner -= 1;
            w.lambda.set(i, std::min(lo + range * partner, hi));
        }
        return w;
    }
    static Wavelengths rgb() { return {}; }

    /// Keeps the first wavelength only, after an event that sends each wavelength another way (dispersion).
    /// The other lanes count no more at the sensor. Does nothing in RGB mode and when done already.
    void terminate_secondary() {
        if (mode == ColorMode::rgb || secondary_terminated()) return;
        pdf = Spectrum(pdf[0] / 4, 0, 0, 0);
    }
    bool secondary_terminated() const {
        return mode == ColorMode::spectral && pdf[1] == 0 && pdf[2] == 0 && pdf[3] == 0;
    }

    /// The one number that stands for s where only one can be used (the index that bends the path): the first
    /// wavelength's, or in RGB mode the mean of the channels.
    float hero(Spectrum s) const { return mode == ColorMode::rgb ? s[3] : s[0]; }
};

} // namespace alhazen
