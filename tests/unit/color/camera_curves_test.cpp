#include "color/camera_curves.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "color/color_space.h"
#include "color/sensor.h"

namespace alhazen {
namespace {

const CameraCurves& camera(std::string_view name) {
    return *find_camera_curves(name);
}

TEST(CameraCurves, AreTheSensorsBesidesTheObserver) {
    auto all = all_camera_curves();
    ASSERT_EQ(all.size() + 1, sensor_names.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_EQ(all[i].name, sensor_names[i + 1]);
        EXPECT_EQ(find_camera_curves(all[i].name), &all[i]);
    }
    EXPECT_EQ(find_camera_curves("cie1931"), nullptr);
    EXPECT_EQ(find_camera_curves("canon"), nullptr);
}

// What the measurements of all cameras have in common.
TEST(CameraCurves, RiseToOneAndPeakInTheirColours) {
    for (const CameraCurves& c : all_camera_curves()) {
        auto at = [&](std::size_t i, std::size_t channel) { return c.rgb[3 * i + channel]; };
        auto peak = [&](std::size_t channel) {
            std::size_t best = 0;
            for (std::size_t i = 0; i < c.count; ++i)
                if (at(i, channel) > at(best, channel)) best = i;
            return c.lambda_first + c.lambda_step * static_cast<int>(best);
        };
        for (float value : c.rgb) {
            EXPECT_GT(value, 0) << c.name;
            EXPECT_LE(value, 1) << c.name;
        }
        EXPECT_EQ(at(14, 1), 1) << c.name;
        EXPECT_EQ(peak(1), 520) << c.name;
        EXPECT_TRUE(peak(0) == 590 || peak(0) == 600) << c.name;
        EXPECT_TRUE(peak(2) == 470 || peak(2) == 480) << c.name;
        EXPECT_EQ(at(34, 0), at(34, 1)) << c.name;
        EXPECT_EQ(at(34, 0), at(34, 2)) << c.name;
    }
}

TEST(CameraCurves, AreLinearBetweenTheirSamplesAndDarkOutside) {
    const CameraCurves& c = camera("nikon_d850");
    ObserverSample s = c.sample(Spectrum(580, 585, 379.9f, 720.1f));
    EXPECT_EQ(s.x[0], 0.3793366816f);
    EXPECT_EQ(s.y[0], 0.4434085701f);
    EXPECT_EQ(s.z[0], 0.0109965803f);
    EXPECT_FLOAT_EQ(s.x[1], (0.3793366816f + 0.6755740446f) / 2);
    for (int lane : {2, 3}) EXPECT_EQ(s.x[lane] + s.y[lane] + s.z[lane], 0);
    ObserverSample ends = c.sample(Spectrum(380, 720, 360, 830));
    EXPECT_EQ(ends.z[0], 0.0023063903f);
    EXPECT_EQ(ends.z[1], 0.0015179675f);
    for (float lambda = 360; lambda <= 830; lambda += 0.7f) {
        ObserverSample here = c.sample(Spectrum(lambda));
        EXPECT_NEAR(here.x[0], c.curve(0).eval(lambda), 1e-6f) << lambda;
        EXPECT_NEAR(here.y[0], c.curve(1).eval(lambda), 1e-6f) << lambda;
        EXPECT_NEAR(here.z[0], c.curve(2).eval(lambda), 1e-6f) << lambda;
    }
}

TEST(ColorChecker, EndsWithSixGreys) {
    ASSERT_EQ(color_checker().size(), 24u);
    float last = 2;
    for (std::size_t i = 18; i < 24; ++i) {
        const SpectralCurve& grey = color_checker()[i];
        for (float lambda = 450; lambda <= 650; lambda += 10)
            EXPECT_NEAR(grey.eval(lambda), grey.eval(550), 0.06f * grey.eval(550));
        EXPECT_LT(grey.eval(550), 0.8f * last);
        last = grey.eval(550);
    }
    EXPECT_EQ(color_checker()[0].eval(380), 0.055f);
    EXPECT_EQ(color_checker()[23].eval(740), 0);
}

// Expected: the same least squares by numpy (lstsq, a QR decomposition, not the normal equations) from the
// same tables; the illuminants there are float64.
TEST(XyzFromCamera, IsTheLeastSquaresFit) {
    auto expect = [](std::string_view name, float kelvin, std::array<double, 9> expected) {
        auto m = xyz_from_camera(camera(name), SpectralCurve::daylight(kelvin), *srgb_space().illuminant);
        ASSERT_TRUE(m);
        for (std::size_t i = 0; i < 9; ++i)
            EXPECT_NEAR(m->m[i / 3][i % 3], expected[i], 2e-5) << name << ", entry " << i;
    };
    expect("canon_eos_5d_mkiv", 6500,
           {1.892418, -0.071913, 0.250064, 0.748324, 0.965603, -0.399638, 0.183792, -0.584526, 2.067922});
    expect("nikon_d850", 5000,
           {1.414598, 0.298164, 0.213654, 0.579129, 1.130624, -0.273058, 0.213417, -0.543756, 2.554355});
    expect("canon_eos_100d", 6500,
           {1.814862, 0.042814, 0.201989, 0.69371, 0.978141, -0.337135, 0.149103, -0.409969, 1.968062});
}

TEST(XyzFromCamera, DoesNotDependOnTheBrightnessOfTheLights) {
    SpectralCurve light = SpectralCurve::daylight(5000);
    Matrix3 a = *xyz_from_camera(camera("sony_ilce_9"), light, *srgb_space().illuminant);
    Matrix3 b =
        *xyz_from_camera(camera("sony_ilce_9"), light.scaled(8), srgb_space().illuminant->scaled(0.25f));
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(a.m[i / 3][i % 3], b.m[i / 3][i % 3], 1e-9);
}

TEST(XyzFromCamera, NeedsLightToSeeBy) {
    const SpectralCurve& d65 = *srgb_space().illuminant;
    EXPECT_FALSE(xyz_from_camera(camera("nikon_d850"), SpectralCurve::constant(0), d65));
    EXPECT_FALSE(xyz_from_camera(camera("nikon_d850"), SpectralCurve::daylight(200), d65));
    // One spectral line.
    std::array<float, 6> line{549, 0, 550, 1, 551, 0};
    EXPECT_FALSE(xyz_from_camera(camera("nikon_d850"), SpectralCurve::from_pairs(line), d65));
}

} // namespace
} // namespace alhazen
