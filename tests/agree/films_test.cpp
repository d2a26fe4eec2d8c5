/// Films that keep more than red, green and blue.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "color/color_space.h"
#include "color/spectral.h"
#include "tests/support/render_scene.h"

namespace alhazen {
namespace {

using ::testing::HasSubstr;
using testing::render_text;

// A camera at (1, 2, -3) that looks along +z, a floor at y = 0 turned away by some degrees, a ball.
std::string scene_on(const std::string& film, const std::string& integrator = "path") {
    return "Film \"" + film +
           "\" \"integer xresolution\" 24 \"integer yresolution\" 18\n"
           "PixelFilter \"box\" \"float xradius\" 0.001 \"float yradius\" 0.001\n"
           "Integrator \"" +
           integrator +
           "\"\nSampler \"zsobol\" \"integer pixelsamples\" 4\n"
           "LookAt 1 2 -3  1 2 0  0 1 0\nCamera \"perspective\" \"float fov\" 60\nWorldBegin\n"
           "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n"
           "AttributeBegin\nMaterial \"diffuse\" \"rgb reflectance\" [ .2 .4 .6 ]\n"
           "Translate 1 2 2\nShape \"sphere\" \"float radius\" 0.5\nAttributeEnd\n"
           "Material \"diffuse\" \"rgb reflectance\" [ .7 .5 .3 ]\n"
           "Shape \"bilinearmesh\" \"point3 P\" [ -20 0 -5  20 0 -5  -20 4 30  20 4 30 ]\n";
}
RenderSettings settings_in(ColorMode mode) {
    RenderSettings settings;
    settings.color = mode;
    return settings;
}
std::string error_of(const std::string& scene, const RenderSettings& settings = {}) {
    try {
        render_text(scene, settings);
    } catch (const SceneError& e) {
        return e.what();
    }
    return "no error";
}
float value(const Image& image, int x, int y, std::string_view channel) {
    return image.at(x, y, *image.channel_index(channel));
}
Vec3 vector_at(const Image& image, int x, int y, const std::string& name, std::string_view axes = "XYZ") {
    auto part = [&](std::size_t i) { return value(image, x, y, name + "." + axes[i]); };
    return {part(0), part(1), part(2)};
}
void expect_near(Vec3 a, Vec3 b, float tolerance) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance) << c;
}
// The direction of a pixel's ray, in the camera's frame.
Vec3 direction(int x, int y) {
    const float half = std::tan(radians(30.0f));
    return {(static_cast<float>(x) + 0.5f - 12) / 9 * half, (9 - static_cast<float>(y) - 0.5f) / 9 * half, 1};
}

TEST(GBuffer, ColourIsThatOfTheRgbFilm) {
    for (ColorMode mode : {ColorMode::rgb, ColorMode::spectral}) {
        const Image rgb = render_text(scene_on("rgb"), settings_in(mode)).image;
        const Image more = render_text(scene_on("gbuffer"), settings_in(mode)).image;
        for (int y = 0; y < rgb.height(); ++y)
            for (int x = 0; x < rgb.width(); ++x) ASSERT_EQ(more.rgb(x, y), rgb.rgb(x, y)) << x << " " << y;
    }
}

TEST(GBuffer, PlacesNormalsAndSlopesAreThoseOfTheSurface) {
    const Image image = render_text(scene_on("gbuffer")).image;
    // y = (z + 5) 4 / 35 in the world; the camera is at (1, 2, -3), so y + 2 = (z + 2) 4 / 35 in its frame.
    const float slope = 4.0f / 35;
    const Vec3 normal = normalize(Vec3(0, 1, -slope));
    auto depth = [&](Vec3 d) { return (2 * slope - 2) / (d.y - slope * d.z); };
    for (int y : {12, 15})
        for (int x : {2, 20}) {
            const Vec3 d = direction(x, y);
            const float z = depth(d);
            expect_near(vector_at(image, x, y, "P"), d * z, 0.02f * z);
            expect_near(vector_at(image, x, y, "N"), normal, 1e-4f);
            expect_near(vector_at(image, x, y, "Ns"), normal, 1e-4f);
            const float below = std::abs(depth(direction(x, y + 1)) - z);
            EXPECT_NEAR(value(image, x, y, "dzdy"), below, 0.03f * below);
            EXPECT_NEAR(value(image, x, y, "dzdx"), 0, 1e-3f);
        }
    // The ball's nearest point, 4.5 in front of the camera.
    expect_near(vector_at(image, 12, 9, "P"), {0.08f, -0.08f, 4.5f}, 0.1f);
    EXPECT_LT(vector_at(image, 12, 9, "N").z, -0.9f);
    // The sky.
    EXPECT_EQ(vector_at(image, 2, 1, "P"), Vec3());
    EXPECT_EQ(vector_at(image, 2, 1, "N"), Vec3());
}

TEST(GBuffer, WorldCoordinatesWhereAskedFor) {
    std::string scene = scene_on("gbuffer");
    scene.replace(scene.find("\"gbuffer\""), 9, "\"gbuffer\" \"string coordinatesystem\" \"world\"");
    const Image world = render_text(scene).image, camera = render_text(scene_on("gbuffer")).image;
    expect_near(vector_at(world, 5, 14, "P"), vector_at(camera, 5, 14, "P") + Vec3(1, 2, -3), 1e-4f);
}

TEST(GBuffer, PlacesAreThoseSeenFromWhereTheCameraIsThen) {
    // A camera that comes 4 nearer to a wall 10 away, and opens its shutter at the end of that.
    auto scene = [](const std::string& motion, const std::string& shutter) {
        return "Film \"gbuffer\" \"integer xresolution\" 8 \"integer yresolution\" 8\n" + motion +
               "Camera \"perspective\" " + shutter +
               "\nWorldBegin\nShape \"bilinearmesh\" \"point3 P\" [ -50 -50 10  50 -50 10  -50 50 10  50 50 "
               "10 ]\n";
    };
    const std::string motion = "ActiveTransform EndTime\nTranslate 0 0 -4\nActiveTransform All\n";
    const Image image =
        render_text(scene(motion, "\"float shutteropen\" .999 \"float shutterclose\" 1")).image;
    EXPECT_NEAR(vector_at(image, 3, 4, "P").z, 6, 0.01f);
    EXPECT_NEAR(vector_at(image, 3, 4, "N").z, -1, 1e-4f);
    const Image still = render_text(scene("", "")).image;
    EXPECT_NEAR(vector_at(still, 3, 4, "P").z, 10, 1e-4f);
}

TEST(GBuffer, AlbedoIsTheMaterialsColour) {
    for (ColorMode mode : {ColorMode::rgb, ColorMode::spectral}) {
        RenderSettings settings = settings_in(mode);
        settings.spp = 256;
        const Image image = render_text(scene_on("gbuffer"), settings).image;
        expect_near(vector_at(image, 5, 15, "Albedo", "RGB"), {0.7f, 0.5f, 0.3f}, 0.02f);
        expect_near(vector_at(image, 12, 9, "Albedo", "RGB"), {0.2f, 0.4f, 0.6f}, 0.02f);
    }
}

TEST(GBuffer, VarianceIsThatOfTheSamples) {
    RenderSettings settings = settings_in(ColorMode::rgb);
    settings.spp = 1024;
    settings.overrides = {"sampler.seed=1"};
    std::string scene = scene_on("gbuffer");
    scene.replace(scene.find("zsobol"), 6, "independent");
    const Image many = render_text(scene, settings).image;
    EXPECT_NEAR(vector_at(many, 2, 1, "Variance", "RGB").x, 0, 1e-10f); // the sky: 1, always
    // Of single samples over all of a stripe, whose pixels are much alike.
    settings.spp = 1;
    double sum = 0, squares = 0, expected = 0;
    int n = 0;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        settings.seed = seed;
        const Image one = render_text(scene, settings).image;
        for (int x = 4; x < 20; ++x, ++n) {
            const double v = static_cast<double>(one.rgb(x, 16).x);
            sum += v;
            squares += v * v;
        }
    }
    for (int x = 4; x < 20; ++x)
        expected += static_cast<double>(vector_at(many, x, 16, "Variance", "RGB").x) / 16;
    const double variance = squares / n - sum / n * (sum / n);
    ASSERT_GT(expected, 1e-6);
    EXPECT_NEAR(variance / expected, 1, 0.25);
    EXPECT_NEAR(value(many, 6, 16, "RelativeVariance.R"),
                vector_at(many, 6, 16, "Variance", "RGB").x / many.rgb(6, 16).x, 1e-5f);
}

TEST(GBuffer, LooksThroughBordersBetweenMedia) {
    const std::string scene = scene_on("gbuffer", "volpath");
    const std::string mist =
        "MakeNamedMedium \"mist\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [ .001 .001 .001 ]\n"
        "AttributeBegin\nMaterial \"interface\"\nMediumInterface \"mist\" \"\"\n"
        "Translate 1 2 2\nShape \"sphere\" \"float radius\" 1\nAttributeEnd\n";
    const Image clear = render_text(scene).image, misty = render_text(scene + mist).image;
    expect_near(vector_at(misty, 12, 9, "P"), vector_at(clear, 12, 9, "P"), 1e-4f);
}

TEST(GBuffer, IsRefusedWhereCameraRaysAreNotFollowed) {
    for (const char* integrator : {"mlt", "sppm", "lightpath", "raster"})
        EXPECT_THAT(error_of(scene_on("gbuffer", integrator)),
                    HasSubstr("use film \"rgb\", or integrator \"path\""))
            << integrator;
}

TEST(SpectralFilm, RangesHoldTheLightsSpectrum) {
    // A sky whose radiance grows in proportion to the wavelength above 360 nm.
    const std::string scene = "Film \"spectral\" \"integer xresolution\" 4 \"integer yresolution\" 4\n"
                              "Sampler \"zsobol\" \"integer pixelsamples\" 256\nWorldBegin\n"
                              "LightSource \"infinite\" \"spectrum L\" [ 360 0 830 1 ]\n";
    const Image image = render_text(scene).image;
    EXPECT_EQ(image.channels(), 19);
    EXPECT_TRUE(image.channel_index("S0.374,688nm"));
    EXPECT_EQ(image.info.metadata.at("spectralLayoutVersion"), "1.0");
    const float last = image.at(1, 1, 18);
    ASSERT_GT(last, 0);
    for (int i = 0; i < 16; ++i)
        EXPECT_NEAR(image.at(1, 1, 3 + i) / last, (static_cast<float>(i) + 0.5f) / 15.5f, 0.01f) << i;
    // Its luminance: the ranges' radiance as the eye sees it.
    double seen = 0;
    for (int nm = 360; nm < 830; ++nm) {
        const int range = std::min(15, static_cast<int>((nm + 0.5 - 360) / 470 * 16));
        seen += static_cast<double>(cie_y().eval(static_cast<float>(nm) + 0.5f) * image.at(1, 1, 3 + range));
    }
    const double luminance = srgb_space().to_xyz(image.rgb(1, 1)).y;
    EXPECT_NEAR(seen / luminance, 1, 0.02);
}

TEST(SpectralFilm, ColourIsThatOfTheRgbFilm) {
    RenderSettings settings = settings_in(ColorMode::spectral);
    settings.spp = 512;
    const Image rgb = render_text(scene_on("rgb"), settings).image;
    const Image more = render_text(scene_on("spectral"), settings).image;
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(testing::mean_of(more, c) / testing::mean_of(rgb, c), 1, 0.005) << c;
}

TEST(SpectralFilm, SaysWhatItNeeds) {
    EXPECT_THAT(error_of(scene_on("spectral"), settings_in(ColorMode::rgb)),
                HasSubstr("needs spectral colours"));
    EXPECT_THAT(error_of(scene_on("spectral", "mlt")), HasSubstr("not possible with film \"spectral\""));
    std::string scene = scene_on("spectral");
    scene.replace(scene.find("\"spectral\""), 10,
                  "\"spectral\" \"float lambdamin\" 700 \"float lambdamax\" 600");
    EXPECT_THAT(error_of(scene), HasSubstr("lambdamin (700 nm) must be below lambdamax (600 nm)"));
    scene.replace(scene.find("\"float lambdamin\" 700 \"float lambdamax\" 600"), 43,
                  "\"float lambdamin\" 500 \"float lambdamax\" 500.0010");
    EXPECT_THAT(error_of(scene), HasSubstr("ranges of wavelengths are so narrow"));
}

} // namespace
} // namespace alhazen
