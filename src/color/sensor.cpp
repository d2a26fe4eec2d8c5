#include "color/sensor.h"

#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "base/messages.h"
#include "color/camera_curves.h"

namespace alhazen {

namespace {

// Of cameras whose white balance is not given (pbrt-v4).
constexpr float camera_kelvin = 6500;

} // namespace

std::optional<Sensor> Sensor::find(const SensorSettings& settings, const RgbColorSpace& output,
                                   std::string& error) {
    const CameraCurves* camera = find_camera_curves(settings.name);
    if (!camera && settings.name != "cie1931") {
        const std::vector<std::string> names(sensor_names.begin(), sensor_names.end());
        error = fmt::format("unknown sensor \"{}\"{}", settings.name, did_you_mean(settings.name, names));
        return std::nullopt;
    }
    auto check = [&](const char* what, float value) {
        if (std::isfinite(value) && value >= 0) return true;
        error = fmt::format("{} of the sensor is {}; expected a finite number, 0 or more", what, value);
        return false;
    };
    if (!check("exposure time", settings.exposure_time) || !check("iso", settings.iso) ||
        !check("white balance", settings.white_balance))
        return std::nullopt;
    Sensor sensor;
    sensor.imaging_ratio_ = settings.exposure_time * settings.iso / 100;
    sensor.camera_ = camera;
    const float kelvin = camera && settings.white_balance == 0 ? camera_kelvin : settings.white_balance;
    if (kelvin == 0) return sensor;
    const SpectralCurve light = SpectralCurve::daylight(kelvin);
    const Vec3d white = cie_integrals(light);
    if (white.y > 0) sensor.white_balance_ = adapt_white(chromaticity(white), output.white);
    sensor.xyz_from_channels_ = sensor.white_balance_;
    if (!camera) return sensor;
    const std::optional<Matrix3> fitted = xyz_from_camera(*camera, light, *output.illuminant);
    if (!fitted) {
        error = fmt::format("white balance of the sensor is {} K; by that light {} sees no colours", kelvin,
                            settings.name);
        return std::nullopt;
    }
    sensor.xyz_from_channels_ = *fitted;
    return sensor;
}

Vec3 Sensor::measure_spectrum(Spectrum radiance, const Wavelengths& wavelengths) const {
    Spectrum weighted = safe_divide(radiance, wavelengths.pdf);
    ObserverSample curves =
        camera_ ? camera_->sample(wavelengths.lambda) : sample_observer(wavelengths.lambda);
    return Vec3((curves.x * weighted).average(), (curves.y * weighted).average(),
                (curves.z * weighted).average()) *
           imaging_ratio_;
}

Matrix3 Sensor::output_from_sensor(const RgbColorSpace& output, ColorMode mode) const {
    if (mode == ColorMode::spectral) return output.rgb_from_xyz * xyz_from_channels_;
    if (white_balance_ == Matrix3{}) return convert_rgb(srgb_space(), output);
    return output.rgb_from_xyz * white_balance_ * srgb_space().xyz_from_rgb;
}

} // namespace alhazen
