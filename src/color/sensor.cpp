#include "color/sensor.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/messages.h"

namespace alhazen {

const std::vector<std::string>& Sensor::names() {
    static const std::vector<std::string> list{"cie1931"};
    return list;
}

bool Sensor::is_camera(std::string_view name) {
    static constexpr std::array<std::string_view, 17> cameras{
        "canon_eos_100d", "canon_eos_1dx_mkii", "canon_eos_200d",     "canon_eos_200d_mkii",
        "canon_eos_5d",   "canon_eos_5d_mkii",  "canon_eos_5d_mkiii", "canon_eos_5d_mkiv",
        "canon_eos_5ds",  "canon_eos_m",        "hasselblad_l1d_20c", "nikon_d810",
        "nikon_d850",     "sony_ilce_6400",     "sony_ilce_7m3",      "sony_ilce_7rm3",
        "sony_ilce_9"};
    return std::find(cameras.begin(), cameras.end(), name) != cameras.end();
}

std::optional<Sensor> Sensor::find(const SensorSettings& settings, const RgbColorSpace& output,
                                   std::string& error) {
    if (settings.name != "cie1931") {
        error = fmt::format("unknown sensor \"{}\"{}", settings.name, did_you_mean(settings.name, names()));
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
    if (settings.white_balance > 0) {
        Vec3d white = cie_integrals(SpectralCurve::daylight(settings.white_balance));
        if (white.y > 0) sensor.white_balance_ = adapt_white(chromaticity(white), output.white);
    }
    return sensor;
}

Vec3 Sensor::to_sensor_rgb(Spectrum radiance, const Wavelengths& wavelengths) const {
    if (wavelengths.mode == ColorMode::rgb)
        return Vec3(radiance[0], radiance[1], radiance[2]) * imaging_ratio_;
    Spectrum weighted = safe_divide(radiance, wavelengths.pdf);
    ObserverSample observer = sample_observer(wavelengths.lambda);
    return Vec3((observer.x * weighted).average(), (observer.y * weighted).average(),
                (observer.z * weighted).average()) *
           imaging_ratio_;
}

Matrix3 Sensor::output_from_sensor(const RgbColorSpace& output, ColorMode mode) const {
    if (mode == ColorMode::spectral) return output.rgb_from_xyz * white_balance_;
    if (white_balance_ == Matrix3{}) return convert_rgb(srgb_space(), output);
    return output.rgb_from_xyz * white_balance_ * srgb_space().xyz_from_rgb;
}

} // namespace alhazen
