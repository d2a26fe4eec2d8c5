#include "color/spectrum_value.h"

#include <gtest/gtest.h>

#include "base/hash.h"
#include "tests/unit/color/film.h"

namespace alhazen {
namespace {

using test::film_rgb;
using test::film_rgb_of_light;
using test::largest_difference;

Vec3 random_color(Rng& rng) {
    return {rng.uniform(), rng.uniform(), rng.uniform()};
}

/// The film's colour of a diffuse surface of reflectance rho lit so that white would show as the light's
/// colour.
Vec3 lit(ColorMode mode, const SpectrumValue& light, const SpectrumValue& rho) {
    float scale = light.light_scale(mode);
    return film_rgb(mode, [&](const Wavelengths& w) { return scale * light.eval(w) * rho.eval(w); });
}

TEST(SpectrumValue, RgbLightsShowAsTheirRgbInBothModes) {
    Rng rng(1);
    for (int i = 0; i < 20; ++i) {
        Vec3 rgb = random_color(rng) * 5;
        SpectrumValue light = SpectrumValue::illuminant_rgb(srgb_space(), rgb);
        EXPECT_LT(largest_difference(film_rgb_of_light(ColorMode::rgb, light), rgb), 1e-5f * 5);
        EXPECT_LT(largest_difference(film_rgb_of_light(ColorMode::spectral, light), rgb), 1e-3f * 5);
    }
}

TEST(SpectrumValue, GreySurfacesScaleTheLightInBothModes) {
    Rng rng(2);
    for (int i = 0; i < 20; ++i) {
        Vec3 rgb = random_color(rng);
        float grey = rng.uniform();
        SpectrumValue light = SpectrumValue::illuminant_rgb(srgb_space(), rgb);
        SpectrumValue rho = SpectrumValue::albedo_rgb(srgb_space(), Vec3(grey));
        EXPECT_LT(largest_difference(lit(ColorMode::rgb, light, rho), rgb * grey), 1e-5f);
        EXPECT_LT(largest_difference(lit(ColorMode::spectral, light, rho), rgb * grey), 1e-3f);
    }
}

// Under white light a surface shows its own RGB: the definition of upsampling.
TEST(SpectrumValue, SurfacesShowAsTheirRgbUnderWhiteInBothModes) {
    Rng rng(3);
    SpectrumValue white = SpectrumValue::illuminant_rgb(srgb_space(), Vec3(1));
    for (int i = 0; i < 20; ++i) {
        Vec3 rgb = random_color(rng);
        SpectrumValue rho = SpectrumValue::albedo_rgb(srgb_space(), rgb);
        EXPECT_LT(largest_difference(lit(ColorMode::rgb, white, rho), rgb), 1e-5f);
        EXPECT_LT(largest_difference(lit(ColorMode::spectral, white, rho), rgb), 1e-3f);
    }
}

// Coloured light on coloured surfaces multiplies spectra, not RGB: the modes differ, but not by much.
TEST(SpectrumValue, ColoredLightOnColoredSurfacesIsCloseInBothModes) {
    Rng rng(4);
    double sum = 0;
    constexpr int count = 60;
    for (int i = 0; i < count; ++i) {
        Vec3 rgb = Vec3(0.2f) + random_color(rng) * 0.8f, albedo = random_color(rng);
        SpectrumValue light = SpectrumValue::illuminant_rgb(srgb_space(), rgb);
        SpectrumValue rho = SpectrumValue::albedo_rgb(srgb_space(), albedo);
        EXPECT_LT(largest_difference(lit(ColorMode::rgb, light, rho), rgb * albedo), 1e-5f);
        float difference = largest_difference(lit(ColorMode::spectral, light, rho), rgb * albedo);
        EXPECT_LT(difference, 0.2f);
        sum += difference;
    }
    EXPECT_LT(sum / count, 0.04);
}

TEST(SpectrumValue, BlackbodiesAndLampsAgreeInBothModes) {
    std::vector<SpectrumValue> lights;
    for (float kelvin : {2200.0f, 2856.0f, 4000.0f, 6504.0f, 12000.0f})
        lights.push_back(SpectrumValue::blackbody(kelvin));
    for (const char* name : {"stdillum-A", "stdillum-D50", "stdillum-D65", "stdillum-F2", "stdillum-F11"})
        lights.push_back(SpectrumValue::curve(*named_spectrum(name), SpectrumRole::illuminant));
    lights.push_back(SpectrumValue::constant(3, SpectrumRole::illuminant));
    for (const SpectrumValue& light : lights) {
        Vec3 spectral = film_rgb_of_light(ColorMode::spectral, light);
        Vec3 rgb = film_rgb_of_light(ColorMode::rgb, light);
        EXPECT_LT(largest_difference(spectral, rgb), 3e-3f);
        // Lights with a spectrum are scaled to luminance 1.
        EXPECT_NEAR(srgb_space().to_xyz(rgb).y, 1, 1e-4f);
    }
}

TEST(SpectrumValue, LampsUnscaledKeepTheirRatioInBothModes) {
    // Lights may leave out the photometric factor on both sides of a ratio: twice the power is twice the
    // film.
    SpectrumValue light = SpectrumValue::blackbody(5000);
    EXPECT_NEAR(light.scaled(2).photometric(), 2 * light.photometric(), 1e-3f);
    EXPECT_NEAR(light.light_scale(ColorMode::rgb) / light.light_scale(ColorMode::spectral), cie_y_integral,
                1e-3f);
}

TEST(SpectrumValue, WideSpacesKeepTheirColorInBothModes) {
    SpectrumValue white = SpectrumValue::illuminant_rgb(srgb_space(), Vec3(1));
    Rng rng(5);
    for (const std::string& name : color_space_names()) {
        const RgbColorSpace& space = *find_color_space(name);
        for (int i = 0; i < 5; ++i) {
            Vec3 rgb = Vec3(0.3f) + random_color(rng) * 0.2f;
            Vec3 expected = convert_rgb(space, srgb_space()) * rgb;
            SpectrumValue light = SpectrumValue::illuminant_rgb(space, rgb);
            EXPECT_LT(largest_difference(film_rgb_of_light(ColorMode::rgb, light), expected), 1e-5f);
            EXPECT_LT(largest_difference(film_rgb_of_light(ColorMode::spectral, light), expected), 1e-3f)
                << name;
            EXPECT_LT(largest_difference(SpectrumValue::albedo_rgb(space, rgb).linear_srgb(), expected),
                      1e-6f);
        }
    }
}

TEST(SpectrumValue, RgbLanesHoldTheMean) {
    Spectrum lanes = SpectrumValue::albedo_rgb(srgb_space(), {0.1f, 0.2f, 0.6f}).eval(Wavelengths::rgb());
    EXPECT_FLOAT_EQ(lanes[0], 0.1f);
    EXPECT_FLOAT_EQ(lanes[1], 0.2f);
    EXPECT_FLOAT_EQ(lanes[2], 0.6f);
    EXPECT_FLOAT_EQ(lanes[3], 0.3f);
}

TEST(SpectrumValue, ColorsOutsideSrgbAreClipped) {
    SpectrumValue green = SpectrumValue::albedo_rgb(*find_color_space("rec2020"), {0, 0.8f, 0});
    EXPECT_EQ(green.eval(Wavelengths::rgb())[0], 0);
    SpectrumValue ember = SpectrumValue::blackbody(1000, SpectrumRole::unbounded);
    EXPECT_GE(ember.eval(Wavelengths::rgb()).min(), 0);
}

TEST(SpectrumValue, LightOutsideSrgbKeepsItsColorInBothModes) {
    for (const std::string& name : color_space_names()) {
        const RgbColorSpace& space = *find_color_space(name);
        for (Vec3 rgb : {Vec3(0.2f, 1, 0.3f), Vec3(0.1f, 0.1f, 1), Vec3(1, 0.1f, 0)}) {
            SpectrumValue light = SpectrumValue::illuminant_rgb(space, rgb);
            EXPECT_GT(light.eval(Wavelengths::rgb()).sum(), 0);
            Vec3 seen = convert_rgb(srgb_space(), space) * film_rgb_of_light(ColorMode::rgb, light);
            EXPECT_LT(largest_difference(seen, rgb), 1e-5f) << name;
        }
    }
    SpectrumValue ember = SpectrumValue::blackbody(1000);
    Vec3 expected = film_rgb_of_light(ColorMode::spectral, ember);
    ASSERT_LT(expected.z, 0);
    EXPECT_LT(
        largest_difference(film_rgb_of_light(ColorMode::rgb, ember) / expected.x, expected / expected.x),
        1e-2f);
}

TEST(SpectrumValue, UnboundedRgbIsNotClamped) {
    Wavelengths w = Wavelengths::sample_visible(0.4f);
    SpectrumValue flat = SpectrumValue::unbounded_rgb(srgb_space(), Vec3(7));
    EXPECT_TRUE(flat.is_constant());
    EXPECT_EQ(flat.eval(w), Spectrum(7));
    SpectrumValue v = SpectrumValue::unbounded_rgb(srgb_space(), {4, 2, 1});
    EXPECT_EQ(v.linear_srgb(), Vec3(4, 2, 1));
    SpectrumValue white = SpectrumValue::illuminant_rgb(srgb_space(), Vec3(1));
    EXPECT_LT(largest_difference(lit(ColorMode::spectral, white, v), {4, 2, 1}), 4e-3f);
}

TEST(SpectrumValue, ConstantIsTheSameEverywhere) {
    SpectrumValue v = SpectrumValue::constant(0.25f);
    EXPECT_TRUE(v.is_constant());
    EXPECT_EQ(v.eval(Wavelengths::rgb()), Spectrum(0.25f));
    EXPECT_EQ(v.eval(Wavelengths::uniform(0.1f)), Spectrum(0.25f));
    EXPECT_NEAR(v.photometric(), 0.25f * cie_y_integral, 1e-4f);
    EXPECT_EQ(v.max_value(), 0.25f);
    EXPECT_TRUE(SpectrumValue().is_black());
    EXPECT_EQ(SpectrumValue().eval(Wavelengths::uniform(0)), Spectrum(0));
    EXPECT_EQ(SpectrumValue().light_scale(ColorMode::spectral), 0);
    // A constant curve is a constant.
    auto curve = std::make_shared<const SpectralCurve>(SpectralCurve::constant(1.5f));
    EXPECT_TRUE(SpectrumValue::curve(curve, SpectrumRole::unbounded).is_constant());
}

TEST(SpectrumValue, PhotometricOfAnRgbLightIsThatOfItsWhite) {
    for (Vec3 rgb : {Vec3(1), Vec3(0.2f, 3, 0.1f)})
        EXPECT_NEAR(SpectrumValue::illuminant_rgb(srgb_space(), rgb).photometric(), cie_y_integral, 1e-3f);
    // A black light has no power, and no division by zero.
    SpectrumValue black = SpectrumValue::illuminant_rgb(srgb_space(), Vec3(0));
    EXPECT_TRUE(black.is_black());
    EXPECT_EQ(black.eval(Wavelengths::uniform(0.3f)), Spectrum(0));
}

TEST(SpectrumValue, ScaledScalesBothModes) {
    SpectrumValue v = SpectrumValue::illuminant_rgb(srgb_space(), {1, 0.5f, 0.25f}).scaled(4);
    EXPECT_EQ(v.linear_srgb(), Vec3(4, 2, 1));
    EXPECT_LT(largest_difference(film_rgb_of_light(ColorMode::spectral, v), {4, 2, 1}), 4e-3f);
}

TEST(SpectrumValue, MaximumBoundsBothModes) {
    Rng rng(6);
    std::vector<SpectrumValue> values{
        SpectrumValue::blackbody(3000),
        SpectrumValue::curve(*named_spectrum("stdillum-F11"), SpectrumRole::illuminant)};
    for (int i = 0; i < 10; ++i) {
        values.push_back(SpectrumValue::illuminant_rgb(srgb_space(), random_color(rng)));
        values.push_back(SpectrumValue::albedo_rgb(srgb_space(), random_color(rng)));
    }
    for (const SpectrumValue& v : values) {
        EXPECT_LE(v.eval(Wavelengths::rgb()).max(), v.max_value());
        for (float u = 0; u < 0.25f; u += 0.01f)
            EXPECT_LE(v.eval(Wavelengths::uniform(u)).max(), v.max_value() * 1.0001f);
    }
}

// Reflectance of copper at normal incidence, ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2).
TEST(SpectrumValue, CopperLooksLikeCopper) {
    SpectrumValue eta = SpectrumValue::curve(*named_spectrum("metal-Cu-eta"), SpectrumRole::unbounded);
    SpectrumValue k = SpectrumValue::curve(*named_spectrum("metal-Cu-k"), SpectrumRole::unbounded);
    SpectrumValue white = SpectrumValue::illuminant_rgb(srgb_space(), Vec3(1));
    for (ColorMode mode : {ColorMode::spectral, ColorMode::rgb}) {
        float scale = white.light_scale(mode);
        Vec3 rgb = film_rgb(mode, [&](const Wavelengths& w) {
            Spectrum n = eta.eval(w), x = k.eval(w);
            Spectrum below = (n + 1.0f) * (n + 1.0f) + x * x, above = (n - 1.0f) * (n - 1.0f) + x * x;
            return scale * white.eval(w) * above / below;
        });
        EXPECT_GT(rgb.x, 0.85f);
        EXPECT_LT(rgb.x, 1.05f);
        EXPECT_GT(rgb.x, rgb.y + 0.15f);
        EXPECT_GT(rgb.y, rgb.z + 0.05f);
        EXPECT_GT(rgb.z, 0.35f);
    }
}

TEST(SpectrumValue, CurvesOwnedBySharedPointersLive) {
    SpectrumValue v;
    {
        const float pairs[] = {400, 0.2f, 700, 0.8f};
        v = SpectrumValue::curve(std::make_shared<const SpectralCurve>(SpectralCurve::from_pairs(pairs)),
                                 SpectrumRole::albedo);
    }
    Wavelengths w = Wavelengths::uniform(0.25f);
    EXPECT_NEAR(v.eval(w)[0], 0.2f + 0.6f * (477.5f - 400) / 300, 1e-5f);
    EXPECT_GT(v.linear_srgb().x, v.linear_srgb().z);
}

} // namespace
} // namespace alhazen
