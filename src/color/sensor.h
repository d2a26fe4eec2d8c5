/// From radiance along a path to the three numbers a pixel adds up (Pharr et al. 2023, section 5.4.2).
#pragma once

#include <array>
#include <optional>
#include <string>

#include "base/vec.h"
#include "color/color_space.h"
#include "color/spectrum.h"
#include "color/wavelengths.h"

namespace alhazen {

struct CameraCurves;

/// The sensors of pbrt-v4: the CIE observer, and cameras.
inline constexpr std::array sensor_names{
    "cie1931",       "canon_eos_100d",     "canon_eos_1dx_mkii", "canon_eos_200d",    "canon_eos_200d_mkii",
    "canon_eos_5d",  "canon_eos_5d_mkii",  "canon_eos_5d_mkiii", "canon_eos_5d_mkiv", "canon_eos_5ds",
    "canon_eos_m",   "hasselblad_l1d_20c", "nikon_d810",         "nikon_d850",        "sony_ilce_6400",
    "sony_ilce_7m3", "sony_ilce_7rm3",     "sony_ilce_9"};

struct SensorSettings {
    std::string name = "cie1931";
    float exposure_time = 1; ///< s
    float iso = 100;
    /// K; the daylight that shall look white; 0 for none, or 6500 for cameras (as pbrt-v4).
    float white_balance = 0;
};

/// Spectral mode: the sensor's channels are XYZ, or the answers of a camera's red, green and blue pixels. RGB
/// mode: they are the radiance's own linear sRGB, whose spectrum nobody knows, so a camera is one that sees
/// as the eye does and differs from the CIE observer by its white balance only. All are multiplied by the
/// imaging ratio, exposure_time iso / 100.
class Sensor {
  public:
    /// The CIE observer, imaging ratio 1, no white balance.
    Sensor() = default;
    /// nullopt, and what is wrong in error, for a name not in sensor_names, settings that are negative or not
    /// finite, or a camera's white balance too low to see colours by (a few hundred K).
    static std::optional<Sensor> find(const SensorSettings& settings, const RgbColorSpace& output,
                                      std::string& error);

    /// The sample's channels; their expectation over the wavelengths is the pixel's. Terminated lanes count
    /// not.
    Vec3 to_sensor_rgb(Spectrum radiance, const Wavelengths& wavelengths) const {
        if (wavelengths.mode == ColorMode::rgb)
            return Vec3(radiance[0], radiance[1], radiance[2]) * imaging_ratio_;
        return measure_spectrum(radiance, wavelengths);
    }
    /// Channels to linear RGB of a space, white balance included.
    Matrix3 output_from_sensor(const RgbColorSpace& output, ColorMode mode) const;
    float imaging_ratio() const { return imaging_ratio_; }

  private:
    Vec3 measure_spectrum(Spectrum radiance, const Wavelengths& wavelengths) const;

    float imaging_ratio_ = 1;
    const CameraCurves* camera_ = nullptr; ///< none: the CIE observer
    Matrix3 white_balance_;                ///< XYZ to XYZ
    Matrix3 xyz_from_channels_;            ///< of spectral mode; white balance included
};

} // namespace alhazen
