/// From radiance along a path to the three numbers a pixel adds up (Pharr et al. 2023, section 5.4.2).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/vec.h"
#include "color/color_space.h"
#include "color/spectrum.h"
#include "color/wavelengths.h"

namespace alhazen {

struct SensorSettings {
    std::string name = "cie1931";
    float exposure_time = 1; ///< s
    float iso = 100;
    float white_balance = 0; ///< K; the daylight that shall look white; 0 for none
};

/// Spectral mode: the sensor's channels are XYZ. RGB mode: they are the radiance's own linear sRGB. Both are
/// multiplied by the imaging ratio, exposure_time iso / 100.
class Sensor {
  public:
    /// The CIE observer, imaging ratio 1, no white balance.
    Sensor() = default;
    /// nullopt, and what is wrong in error, for a name not in names() or settings that are negative or not
    /// finite.
    static std::optional<Sensor> find(const SensorSettings& settings, const RgbColorSpace& output,
                                      std::string& error);
    static const std::vector<std::string>& names();
    /// Whether the name is that of a camera which pbrt-v4 has and whose curves are not included here.
    static bool is_camera(std::string_view name);

    /// The sample's channels; their expectation over the wavelengths is the pixel's. Terminated lanes count
    /// not.
    Vec3 to_sensor_rgb(Spectrum radiance, const Wavelengths& wavelengths) const;
    /// Channels to linear RGB of a space, white balance included.
    Matrix3 output_from_sensor(const RgbColorSpace& output, ColorMode mode) const;
    float imaging_ratio() const { return imaging_ratio_; }

  private:
    float imaging_ratio_ = 1;
    Matrix3 white_balance_; ///< XYZ to XYZ
};

} // namespace alhazen
