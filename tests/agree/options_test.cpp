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

/// Mean of a disk that fills the picture, seen from straight above, under a white sky of 1.
double disk_under_the_sky(const std::string& option, const std::string& materials, ColorMode mode) {
    const std::string text = option + R"(
        Integrator "path" "integer maxdepth" 1
        Film "rgb" "integer xresolution" 16 "integer yresolution" 16
        LookAt 0 0 10  0 0 0  0 1 0
        Camera "perspective" "float fov" 2
        WorldBegin
        LightSource "infinite" "rgb L" [ 1 1 1 ]
        )" + materials + "\nShape \"disk\" \"float radius\" 5\n";
    RenderSettings settings;
    settings.spp = 64;
    settings.color = mode;
    return testing::mean_of(render_text(text, settings).image, 1);
}

// At normal incidence glass reflects 4 %, and what is refracted into it is squeezed to 1 / eta^2.
TEST(Options, ForcediffuseKeepsWhatIsScatteredInAll) {
    const std::string force = "Option \"bool forcediffuse\" true\n";
    const std::string glass = "Material \"dielectric\" \"float eta\" 1.5";
    const double scattered = 0.04 + 0.96 / 2.25;
    struct Case {
        std::string materials;
        double expected;
    };
    // 16384 samples, whose means of four differ by less than 0.5: a standard deviation below 0.002.
    for (const Case& c :
         {Case{"Material \"diffuse\" \"float reflectance\" .3", 0.3}, Case{glass, scattered},
          Case{"Material \"conductor\" \"float eta\" 1 \"float k\" 2", 0.5},
          Case{"MakeNamedMaterial \"a\" \"string type\" \"dielectric\" \"float eta\" 1.5\n"
               "MakeNamedMaterial \"b\" \"string type\" \"diffuse\" \"float reflectance\" .3\n"
               "Material \"mix\" \"string materials\" [ \"a\" \"b\" ]",
               (scattered + 0.3) / 2},
          Case{"Material \"interface\"", 1}})
        for (const ColorMode mode : {ColorMode::rgb, ColorMode::spectral})
            EXPECT_NEAR(disk_under_the_sky(force, c.materials, mode), c.expected, 0.01) << c.materials;
}

// Where light comes from one side only, a mirror shows it or does not; what is matte shows it everywhere.
TEST(Options, ForcediffuseTakesGlossAway) {
    const std::string scene = R"(
        Integrator "path" "integer maxdepth" 1
        Film "rgb" "integer xresolution" 16 "integer yresolution" 16
        LookAt 0 0 10  0 0 0  0 1 0
        Camera "perspective" "float fov" 2
        WorldBegin
        LightSource "distant" "rgb L" [ 1 1 1 ] "point3 from" [ 0 0 1 ] "point3 to" [ 0 0 0 ]
        Material "conductor" "float eta" 1 "float k" 2
        Shape "disk" "float radius" 5
    )";
    RenderSettings settings;
    settings.spp = 16;
    EXPECT_EQ(testing::mean_of(render_text(scene, settings).image, 1), 0);
    EXPECT_NEAR(
        testing::mean_of(render_text("Option \"bool forcediffuse\" true\n" + scene, settings).image, 1),
        0.5 / 3.14159, 0.002);
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
    EXPECT_THAT(error_of("Option \"float displacementedgescale\" 0"), HasSubstr("must be above 0"));
}

} // namespace
} // namespace alhazen
