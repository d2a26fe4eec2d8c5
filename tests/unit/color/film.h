/// What a camera looking at a given spectrum would show, for the tests of the colour room.
#pragma once

#include <functional>

#include "color/sensor.h"
#include "color/spectrum_value.h"

namespace alhazen::test {

/// Mean over wavelength samples, at the midpoints of equal strata, of linear sRGB; in RGB mode, the one
/// value.
inline Vec3 film_rgb(ColorMode mode, const std::function<Spectrum(const Wavelengths&)>& radiance,
                     const Sensor& sensor = Sensor()) {
    Matrix3 output = sensor.output_from_sensor(srgb_space(), mode);
    if (mode == ColorMode::rgb)
        return output * sensor.to_sensor_rgb(radiance(Wavelengths::rgb()), Wavelengths::rgb());
    constexpr int count = 4096;
    Vec3d sum;
    for (int i = 0; i < count; ++i) {
        Wavelengths w = Wavelengths::sample_visible((static_cast<float>(i) + 0.5f) / count);
        sum += Vec3d(sensor.to_sensor_rgb(radiance(w), w));
    }
    return Vec3(output * (sum / count));
}

/// A light of this value, scaled as lights scale it.
inline Vec3 film_rgb_of_light(ColorMode mode, const SpectrumValue& light) {
    float scale = light.light_scale(mode);
    return film_rgb(mode, [&](const Wavelengths& w) { return scale * light.eval(w); });
}

inline float largest_difference(Vec3 a, Vec3 b) {
    return max_component(abs(a - b));
}

} // namespace alhazen::test
