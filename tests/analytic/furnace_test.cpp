/// Scenes whose picture is known on paper, rendered by every integrator that can see them, in both colour
/// modes, with every sampler. Each is a Student's t-test over 16 independent seeds (15 degrees of freedom) at
/// |t| < 7, a false-alarm rate of 4e-6 a comparison; the seeds are fixed, so a passing test stays passing.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "integrators/integrator.h"
#include "samplers/sampler.h"
#include "tests/support/render_scene.h"
#include "tests/support/statistics.h"

namespace alhazen::testing {
namespace {

std::vector<double> green_means(const std::string& text, RenderSettings settings) {
    std::vector<double> means;
    for (int seed = 0; seed < t_test_seeds; ++seed) {
        settings.seed = static_cast<std::uint64_t>(seed);
        means.push_back(mean_of(render_text(text, settings).image, 1));
    }
    return means;
}

struct Case {
    std::string integrator, sampler;
    ColorMode mode;
};

void PrintTo(const Case& c, std::ostream* out) {
    *out << c.integrator << "_" << c.sampler << (c.mode == ColorMode::rgb ? "_rgb" : "_spectral");
}

std::string header(const Case& c, int depth, int spp) {
    return fmt::format(R"(
Integrator "{}" "integer maxdepth" {}
Sampler "{}" "integer {}" {}
PixelFilter "box"
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
Camera "perspective" "float fov" 40
WorldBegin
)",
                       c.integrator, depth, c.sampler,
                       c.sampler == "stratified" ? "xsamples" : "pixelsamples", spp);
}

class Furnace : public ::testing::TestWithParam<Case> {};

// A closed sphere that glows with L = 1/2 and reflects rho = 1/2 of what arrives: the camera inside sees
// 1/2 (1 + 1/2 + 1/4 + ...) = 1/2 / (1 - 1/2) = 1. Cut after 9 surfaces beyond the first: 1 - 2^-10.
TEST_P(Furnace, GlowingDiffuseSphereSeenFromInside) {
    std::string text = header(GetParam(), 9, 16) + R"(
AreaLightSource "diffuse" "rgb L" [ .5 .5 .5 ]
Material "diffuse" "rgb reflectance" [ .5 .5 .5 ]
ReverseOrientation
Shape "sphere" "float radius" 2
)";
    RenderSettings settings;
    settings.color = GetParam().mode;
    EXPECT_LT(std::abs(t_against(green_means(text, settings), 1 - std::pow(2.0, -10), 1e-3)), t_test_limit);
}

// A uniform sky of radiance 1 over a diffuse sphere of albedo rho: a convex body reflects no light to itself,
// so each point shows rho and the sky shows 1. The camera looks at the sphere only.
TEST_P(Furnace, DiffuseSphereUnderAUniformSky) {
    std::string text = header(GetParam(), 4, 16) + R"(
LightSource "infinite" "rgb L" [ 1 1 1 ]
Material "diffuse" "rgb reflectance" [ .6 .6 .6 ]
Translate 0 0 3
Shape "sphere" "float radius" 2
)";
    RenderSettings settings;
    settings.color = GetParam().mode;
    EXPECT_LT(std::abs(t_against(green_means(text, settings), 0.6, 1e-3)), t_test_limit);
}

std::vector<Case> all_cases() {
    std::vector<Case> cases;
    for (const char* integrator : {"path", "simplepath", "randomwalk", "bdpt"})
        for (ColorMode mode : {ColorMode::rgb, ColorMode::spectral})
            cases.push_back({integrator, "zsobol", mode});
    for (const std::string& sampler : sampler_kinds().names())
        if (sampler != "zsobol") cases.push_back({"path", sampler, ColorMode::spectral});
    return cases;
}

INSTANTIATE_TEST_SUITE_P(All, Furnace, ::testing::ValuesIn(all_cases()),
                         [](const auto& test) { return ::testing::PrintToString(test.param); });

// A mirror and a lossless glass sphere in a uniform sky are invisible: everything shows 1. Needs paths long
// enough that almost no light is left inside the glass.
TEST(FurnaceSpecular, MirrorAndGlassVanishInAUniformSky) {
    for (const char* material : {R"("conductor" "spectrum reflectance" "x")",
                                 R"("dielectric" "float eta" 1.5)", R"("thindielectric" "float eta" 1.5)"}) {
        std::string line(material);
        if (line.find("conductor") != std::string::npos) line = R"("conductor" "rgb reflectance" [ 1 1 1 ])";
        std::string text = header({"path", "zsobol", ColorMode::rgb}, 60, 16) +
                           "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\nMaterial " + line +
                           "\nTranslate 0 0 3\nShape \"sphere\" \"float radius\" 2\n";
        RenderSettings settings;
        settings.color = ColorMode::rgb;
        EXPECT_LT(std::abs(t_against(green_means(text, settings), 1.0, 2e-3)), t_test_limit) << line;
    }
}

// An open plane sees the whole sky: ambient occlusion is 1 everywhere, whatever directions are drawn.
TEST(AmbientOcclusion, OpenPlaneIsWhite) {
    for (const char* cosine : {"true", "false"}) {
        std::string text = fmt::format(R"(
Integrator "ambientocclusion" "bool cossample" {}
Sampler "zsobol" "integer pixelsamples" 64
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
LookAt 0 1 0  0 0 0  0 0 1
Camera "perspective" "float fov" 30
WorldBegin
Rotate 90 1 0 0
Shape "disk" "float radius" 100
)",
                                       cosine);
        EXPECT_LT(std::abs(t_against(green_means(text, {}), 1.0, 1e-3)), t_test_limit) << cosine;
    }
}

// In a corner of two half planes at a right angle, a point on the floor sees what the wall leaves of the sky.
// At distance a from a wall of height h (infinitely wide): occluded fraction of the cosine-weighted
// hemisphere is (1 - cos(atan(h / a))) / 2. Here a = 1, h = 1: 1 - (1 - 1/sqrt 2)/2.
TEST(AmbientOcclusion, WallBlocksItsViewFactor) {
    std::string text = R"(
Integrator "ambientocclusion"
Sampler "zsobol" "integer pixelsamples" 256
PixelFilter "box"
Film "rgb" "integer xresolution" 4 "integer yresolution" 4
LookAt 0 .5 0  0 0 0  0 0 1
Camera "perspective" "float fov" .1
WorldBegin
Shape "bilinearmesh" "point3 P" [ -1000 0 -1000  1000 0 -1000  -1000 0 1000  1000 0 1000 ]
Shape "bilinearmesh" "point3 P" [ -1000 0 1  1000 0 1  -1000 1 1  1000 1 1 ]
)";
    EXPECT_LT(std::abs(t_against(green_means(text, {}), 1 - (1 - 1 / std::sqrt(2.0)) / 2, 1e-3)),
              t_test_limit);
}

} // namespace
} // namespace alhazen::testing
