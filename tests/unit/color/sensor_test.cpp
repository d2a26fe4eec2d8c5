#include "color/sensor.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "color/camera_curves.h"
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

// What the sensor makes of a light that a thing of this reflectance reflects, in spectral mode.
Vec3 seen(const Sensor& sensor, const SpectralCurve& light, const SpectralCurve& reflectance) {
    return film_rgb(
        ColorMode::spectral,
        [&](const Wavelengths& w) {
            return light.eval(w.lambda) * reflectance.eval(w.lambda) * (1 / cie_y_integral);
        },
        sensor);
}

// The matrix fits swatches, which are duller than white: computed beforehand by numpy, the luminance is too
// low by 0.7 to 1.0 % at 6500 K, and the channels of white differ by 1.9 % at most (sony_ilce_9), by 2.2 % at
// 5000 K, 3.1 % at 9000 K and 3.5 % in the light of incandescent lamps (canon_eos_5d).
TEST(CameraSensor, GreyStaysGrey) {
    const SpectralCurve grey = SpectralCurve::constant(0.5f);
    const std::pair<float, float> bounds[] = {
        {3200.0f, 0.036f}, {5000.0f, 0.023f}, {6500.0f, 0.0201f}, {9000.0f, 0.032f}};
    for (auto [kelvin, bound] : bounds) {
        for (const CameraCurves& camera : all_camera_curves()) {
            Sensor sensor = sensor_of({std::string(camera.name), 1, 100, kelvin});
            Vec3 rgb = seen(sensor, SpectralCurve::daylight(kelvin), grey);
            EXPECT_LT(max_component(rgb), (1 + bound) * -max_component(-rgb)) << camera.name << " " << kelvin;
            EXPECT_NEAR((srgb_space().xyz_from_rgb * rgb).y, 0.5f, 0.5f * 0.02f)
                << camera.name << " " << kelvin;
        }
    }
}

TEST(CameraSensor, BalancesTo6500KelvinUnlessTold) {
    for (ColorMode mode : {ColorMode::spectral, ColorMode::rgb}) {
        Matrix3 a = sensor_of({"nikon_d850"}).output_from_sensor(srgb_space(), mode);
        EXPECT_EQ(a, sensor_of({"nikon_d850", 1, 100, 6500}).output_from_sensor(srgb_space(), mode));
        EXPECT_FALSE(a == sensor_of({"nikon_d850", 1, 100, 5000}).output_from_sensor(srgb_space(), mode));
    }
}

// The swatches' own linear sRGB under the picture's white, 0 to 1 but for cyan's red. numpy: the largest
// error of any camera and channel is 0.036 (canon_eos_5d), the root mean square 0.0072 to 0.0099.
TEST(CameraSensor, SwatchesKeepTheirColours) {
    const SpectralCurve light = SpectralCurve::daylight(6500);
    for (const CameraCurves& camera : all_camera_curves()) {
        Sensor sensor = sensor_of({std::string(camera.name)});
        double squares = 0;
        for (const SpectralCurve& swatch : color_checker()) {
            Vec3 error = seen(sensor, light, swatch) - seen(Sensor(), *srgb_space().illuminant, swatch);
            EXPECT_LT(max_component(abs(error)), 0.038f) << camera.name;
            squares += dot(Vec3d(error), Vec3d(error));
        }
        EXPECT_LT(std::sqrt(squares / 72), 0.0105) << camera.name;
        EXPECT_GT(std::sqrt(squares / 72), 0.006) << camera.name; // it is a camera, not the observer
    }
}

// Radiance 1 at every wavelength: the channels are the curves' areas, 10 nm (sum - half of the ends) as they
// are linear between samples, here by numpy times the least squares matrix and sRGB's.
TEST(CameraSensor, ConstantRadianceIsTheAreaOfTheCurves) {
    auto white = [](const Sensor& sensor) {
        return film_rgb(
            ColorMode::spectral, [](const Wavelengths&) { return Spectrum(1); }, sensor);
    };
    EXPECT_LT(largest_difference(white(sensor_of({"canon_eos_100d"})), {127.657f, 100.342f, 96.854f}), 0.05f);
    EXPECT_LT(largest_difference(white(sensor_of({"nikon_d850"})), {126.827f, 101.366f, 93.713f}), 0.05f);
    EXPECT_LT(largest_difference(white(sensor_of({"sony_ilce_7rm3"})), {127.771f, 100.659f, 96.408f}), 0.05f);
    Vec3 quarter = white(sensor_of({"canon_eos_5d_mkiv", 0.125f, 200}));
    EXPECT_LT(largest_difference(4 * quarter, {127.819f, 100.882f, 94.265f}), 0.05f);
}

// In RGB mode there are no spectra for the curves to see.
TEST(CameraSensor, IsAWhiteBalancedObserverInRgbMode) {
    for (float kelvin : {3200.0f, 6500.0f, 9000.0f}) {
        Sensor camera = sensor_of({"canon_eos_5d", 0.5f, 100, kelvin});
        Sensor observer = sensor_of({"cie1931", 0.5f, 100, kelvin});
        Spectrum radiance(0.7f, 0.2f, 0.4f, 0);
        EXPECT_EQ(camera.to_sensor_rgb(radiance, Wavelengths::rgb()),
                  observer.to_sensor_rgb(radiance, Wavelengths::rgb()));
        EXPECT_EQ(camera.output_from_sensor(srgb_space(), ColorMode::rgb),
                  observer.output_from_sensor(srgb_space(), ColorMode::rgb));
    }
}

TEST(Sensor, RefusesWhatItDoesNotKnow) {
    auto error_of = [](const SensorSettings& settings) {
        std::string error;
        EXPECT_FALSE(Sensor::find(settings, srgb_space(), error));
        return error;
    };
    EXPECT_EQ(error_of({"canon_eos_100e"}),
              "unknown sensor \"canon_eos_100e\" (did you mean \"canon_eos_100d\"?)");
    EXPECT_EQ(error_of({"nikon_d850", 1, 100, 200}),
              "white balance of the sensor is 200 K; by that light nikon_d850 sees no colours");
    EXPECT_NE(error_of({"nikon_d850", 1, 100, 1e-30f}), "");
    EXPECT_EQ(error_of({"cie1931", -1}),
              "exposure time of the sensor is -1; expected a finite number, 0 or more");
    EXPECT_EQ(error_of({"cie1931", 1, std::numeric_limits<float>::infinity()}),
              "iso of the sensor is inf; expected a finite number, 0 or more");
    EXPECT_NE(error_of({"cie1931", 1, 100, std::numeric_limits<float>::quiet_NaN()}), "");
}

} // namespace
} // namespace alhazen
