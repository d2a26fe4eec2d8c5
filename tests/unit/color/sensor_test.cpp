#include "color/sensor.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/unit/color/film.h"

namespace alhazen {
namespace {

using test::film_rgb;
using test::largest_difference;

Sensor sensor_of(const SensorSettings& settings) {
    std::string error;
    std::optional<Sensor> sensor = Sensor::find(settings, srgb_space(), error);
    EXPECT_TRUE(sensor) << error;
    return sensor.value_or(Sensor());
}

TEST(Sensor, DefaultHasRatioOne) {
    EXPECT_EQ(Sensor().imaging_ratio(), 1);
    EXPECT_EQ(sensor_of({}).imaging_ratio(), 1);
}

TEST(Sensor, ExposureAndIsoScaleBothModes) {
    Sensor sensor = sensor_of({"cie1931", 0.5f, 400, 0});
    EXPECT_FLOAT_EQ(sensor.imaging_ratio(), 2);
    SpectrumValue light = SpectrumValue::illuminant_rgb(srgb_space(), {0.4f, 0.3f, 0.2f});
    for (ColorMode mode : {ColorMode::spectral, ColorMode::rgb}) {
        float scale = light.light_scale(mode);
        Vec3 rgb = film_rgb(
            mode, [&](const Wavelengths& w) { return scale * light.eval(w); }, sensor);
        EXPECT_LT(largest_difference(rgb, {0.8f, 0.6f, 0.4f}), 1e-3f);
    }
}

TEST(Sensor, WhiteBalanceMakesItsDaylightWhite) {
    for (float kelvin : {3200.0f, 4500.0f, 6500.0f, 9000.0f}) {
        Sensor sensor = sensor_of({"cie1931", 1, 100, kelvin});
        auto curve = std::make_shared<const SpectralCurve>(SpectralCurve::daylight(kelvin));
        SpectrumValue light = SpectrumValue::curve(curve, SpectrumRole::illuminant);
        for (ColorMode mode : {ColorMode::spectral, ColorMode::rgb}) {
            float scale = light.light_scale(mode);
            Vec3 rgb = film_rgb(
                mode, [&](const Wavelengths& w) { return scale * light.eval(w); }, sensor);
            EXPECT_LT(largest_difference(rgb, Vec3(1)), 3e-3f) << kelvin;
        }
    }
}

TEST(Sensor, OutputSpacesAgreeOnWhite) {
    Spectrum white(1);
    for (const char* name : {"dci-p3", "rec2020"}) {
        Matrix3 m = Sensor().output_from_sensor(*find_color_space(name), ColorMode::rgb);
        EXPECT_LT(largest_difference(m * Sensor().to_sensor_rgb(white, Wavelengths::rgb()), Vec3(1)), 1e-6f);
    }
}

// Terminating keeps the expectation: only the first wavelength counts, four times.
TEST(Sensor, TerminatedWavelengthsKeepTheExpectation) {
    SpectrumValue light = SpectrumValue::illuminant_rgb(srgb_space(), {0.7f, 0.5f, 0.3f});
    float scale = light.light_scale(ColorMode::spectral);
    Sensor sensor;
    Matrix3 output = sensor.output_from_sensor(srgb_space(), ColorMode::spectral);
    constexpr int count = 8192;
    Vec3d sum;
    for (int i = 0; i < count; ++i) {
        Wavelengths w = Wavelengths::sample_visible((static_cast<float>(i) + 0.5f) / count);
        Spectrum radiance = scale * light.eval(w);
        w.terminate_secondary();
        sum += Vec3d(sensor.to_sensor_rgb(radiance, w));
    }
    EXPECT_LT(largest_difference(Vec3(output * (sum / count)), {0.7f, 0.5f, 0.3f}), 1e-3f);
}

TEST(Sensor, UniformWavelengthsGiveTheSame) {
    SpectrumValue light = SpectrumValue::illuminant_rgb(srgb_space(), {0.7f, 0.5f, 0.3f});
    float scale = light.light_scale(ColorMode::spectral);
    Sensor sensor;
    constexpr int count = 8192;
    Vec3d sum;
    for (int i = 0; i < count; ++i) {
        Wavelengths w = Wavelengths::uniform((static_cast<float>(i) + 0.5f) / count);
        sum += Vec3d(sensor.to_sensor_rgb(scale * light.eval(w), w));
    }
    Matrix3 output = sensor.output_from_sensor(srgb_space(), ColorMode::spectral);
    EXPECT_LT(largest_difference(Vec3(output * (sum / count)), {0.7f, 0.5f, 0.3f}), 1e-3f);
}

TEST(Sensor, RefusesWhatItDoesNotKnow) {
    auto error_of = [](const SensorSettings& settings) {
        std::string error;
        EXPECT_FALSE(Sensor::find(settings, srgb_space(), error));
        return error;
    };
    EXPECT_EQ(error_of({"canon_eos_100d"}), "unknown sensor \"canon_eos_100d\"; known: cie1931");
    EXPECT_EQ(error_of({"cie1931", -1}),
              "exposure time of the sensor is -1; expected a finite number, 0 or more");
    EXPECT_EQ(error_of({"cie1931", 1, std::numeric_limits<float>::infinity()}),
              "iso of the sensor is inf; expected a finite number, 0 or more");
    EXPECT_NE(error_of({"cie1931", 1, 100, std::numeric_limits<float>::quiet_NaN()}), "");
}

} // namespace
} // namespace alhazen
