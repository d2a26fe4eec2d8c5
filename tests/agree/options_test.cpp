/// Option directives that change pictures.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/render_scene.h"

namespace alhazen {
namespace {

using ::testing::HasSubstr;
using testing::render_text;

std::string scene_with(const std::string& option, const std::string& world) {
    return option +
           "\nFilm \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 12\n"
           "Sampler \"independent\" \"integer pixelsamples\" 16\nIntegrator \"path\" \"integer maxdepth\" 0\n"
           "LookAt 0 0 -4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40 \"float lensradius\" .3 "
           "\"float focaldistance\" 2\nWorldBegin\n" +
           world;
}
const std::string glowing_ball = "AreaLightSource \"diffuse\" \"rgb L\" [ 1 2 3 ]\nShape \"sphere\"\n";

RenderSettings in(ColorMode mode, int spp = 16) {
    RenderSettings settings;
    settings.color = mode;
    settings.spp = spp;
    return settings;
}
int count_between(const Image& image, float low, float high) {
    int count = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) count += image.rgb(x, y).x > low && image.rgb(x, y).x < high;
    return count;
}

TEST(Options, WithoutPixelJitterSilhouettesAreHard) {
    const Image soft = render_text(scene_with("", glowing_ball), in(ColorMode::rgb)).image;
    const Image hard =
        render_text(scene_with("Option \"bool disablepixeljitter\" true", glowing_ball), in(ColorMode::rgb))
            .image;
    EXPECT_GT(count_between(soft, 0.01f, 0.99f), 10);
    EXPECT_EQ(count_between(hard, 0.01f, 0.99f), 0);
    EXPECT_GT(count_between(hard, 0.99f, 1.01f), 20);
}

TEST(Options, WithoutWavelengthJitterAllSamplesHaveTheSameColour) {
    auto spread = [](const std::string& option) {
        RenderSettings settings = in(ColorMode::spectral, 1);
        float low = infinity, high = 0;
        const Image image = render_text(scene_with(option, glowing_ball), settings).image;
        for (int y = 5; y < 7; ++y)
            for (int x = 7; x < 9; ++x) {
                low = std::min(low, image.rgb(x, y).x);
                high = std::max(high, image.rgb(x, y).x);
            }
        return high - low;
    };
    EXPECT_GT(spread(""), 0.01f);
    EXPECT_EQ(spread("Option \"bool disablewavelengthjitter\" true"), 0);
}

TEST(Options, WithoutTextureFilteringSquaresAreNotBlended) {
    // Squares much smaller than pixels, glowing by reflecting a sky without shadows.
    const std::string board = "LightSource \"infinite\"\nTexture \"board\" \"spectrum\" \"checkerboard\" "
                              "\"float uscale\" 1000 \"float vscale\" 1000\n"
                              "Material \"diffuse\" \"texture reflectance\" \"board\"\n"
                              "Shape \"bilinearmesh\" \"point3 P\" [ -9 -9 2  9 -9 2  -9 9 2  9 9 2 ]\n";
    auto picture = [&](std::string option) {
        std::string scene = scene_with(option, board);
        scene.replace(scene.find("maxdepth\" 0"), 11, "maxdepth\" 1");
        return render_text(scene, in(ColorMode::rgb, 1)).image;
    };
    EXPECT_EQ(count_between(picture(""), 0.4f, 0.6f), 16 * 12);
    EXPECT_LT(count_between(picture("Option \"bool disabletexturefiltering\" true"), 0.1f, 0.9f), 16);
}

TEST(Options, SaysWhatItDoesNotDo) {
    auto error_of = [](const std::string& option) -> std::string {
        try {
            render_text(scene_with(option, glowing_ball));
        } catch (const SceneError& e) {
            return e.what();
        }
        return "";
    };
    EXPECT_EQ(error_of("Option \"bool forcediffuse\" false"), "");
    EXPECT_THAT(error_of("Option \"bool forcediffuse\" true"),
                HasSubstr("\"forcediffuse\" is not supported"));
    EXPECT_THAT(error_of("Option \"float displacementedgescale\" 0"), HasSubstr("must be above 0"));
}

} // namespace
} // namespace alhazen
