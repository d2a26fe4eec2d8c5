/// Light that is followed from the lamps arrives as the path tracer says: through every camera, by every kind
/// of light, with shading normals, and by each bidirectional strategy alone. Welch's t-test over 16 seeds
/// each, |t| < 7: a false-alarm rate of about 4e-6 a comparison; fixed seeds.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/lit_room.h"
#include "tests/support/render_scene.h"
#include "tests/support/statistics.h"

namespace alhazen::testing {
namespace {

const char* const perspective = R"(Camera "perspective" "float fov" 36)";

struct Setting {
    std::string world;
    std::string camera = perspective;
    ColorMode mode = ColorMode::rgb;
    std::optional<Rect2i> crop = {};
};

std::string scene_text(const std::string& integrator, int spp, const Setting& setting) {
    return fmt::format(R"(Integrator {}
Sampler "independent" "integer pixelsamples" {}
Film "rgb" "integer xresolution" 10 "integer yresolution" 8
LookAt 0 1 -3.4  0 .9 0  0 1 0
{}
WorldBegin
{})",
                       integrator, spp, setting.camera, setting.world);
}

RenderSettings settings_of(const Setting& setting, int seed) {
    RenderSettings settings;
    settings.seed = static_cast<std::uint64_t>(seed);
    settings.color = setting.mode;
    settings.crop = setting.crop;
    return settings;
}

double mean_of_colors(const Image& image) {
    return (mean_of(image, 0) + mean_of(image, 1) + mean_of(image, 2)) / 3;
}

std::vector<double> means_of(const std::string& integrator, int spp, const Setting& setting) {
    std::vector<double> means;
    for (int seed = 0; seed < t_test_seeds; ++seed)
        means.push_back(mean_of_colors(
            render_text(scene_text(integrator, spp, setting), settings_of(setting, seed)).image));
    return means;
}

/// lightpath: whether it sees all that is in the scene.
void expect_agreement(const Setting& setting, bool lightpath) {
    const std::string depth = R"( "integer maxdepth" 3)";
    const auto reference = means_of("\"path\"" + depth, 32, setting);
    ASSERT_GT(moments(reference).mean, 1e-3);
    EXPECT_LT(std::abs(t_between(means_of("\"bdpt\"" + depth, 8, setting), reference, 1e-4)), t_test_limit);
    if (!lightpath) return;
    EXPECT_LT(std::abs(t_between(means_of("\"lightpath\"" + depth, 32, setting), reference, 1e-4)),
              t_test_limit);
}

const std::string ball = R"(
Translate 0 .5 0
Shape "sphere" "float radius" .4
)";

/// Flat triangles, lit and shaded as if they were round.
const std::string octahedron = R"(
Translate 0 .6 0
Shape "trianglemesh" "point3 P" [ 1 0 0  -1 0 0  0 1 0  0 -.6 0  0 0 1  0 0 -1 ]
    "normal N" [ 1 0 0  -1 0 0  0 1 0  0 -1 0  0 0 1  0 0 -1 ]
    "integer indices" [ 0 2 4  4 2 1  1 2 5  5 2 0  4 3 0  1 3 4  5 3 1  0 3 5 ]
)";

TEST(LightTracing, EveryCamera) {
    const std::string world = floor_and_wall + lamp + ball;
    const std::string lens = R"( "float lensradius" .3 "float focaldistance" 3)";
    for (const std::string& camera :
         {std::string(R"(Camera "perspective" "float fov" 50)"), R"(Camera "perspective")" + lens,
          std::string(R"(Camera "orthographic" "float screenwindow" [ -.8 .8 -.8 1.2 ])"),
          R"(Camera "orthographic")" + lens,
          std::string("Scale -2 1 .5\nCamera \"perspective\" \"float fov\" 36")}) {
        SCOPED_TRACE(camera);
        expect_agreement({world, camera}, true);
    }
}

TEST(LightTracing, EveryLight) {
    for (
        const char* light :
        {R"(LightSource "point" "rgb I" [ 1 .8 .6 ] "point3 from" [ .3 1.5 -.3 ])",
         R"(LightSource "point" "rgb I" [ .5 .4 .3 ] "point3 from" [ .3 1.5 -.3 ] "string falloff" "none")",
         R"(Scale 2 1 1 LightSource "spot" "rgb I" [ 2 3 4 ] "point3 from" [ -.5 1.8 -.5 ] "float coneangle" 70
             "point3 to" [ .2 0 .2 ] "float conedeltaangle" 40 Scale .5 1 1)",
         R"(LightSource "distant" "rgb L" [ .4 .4 .3 ] "point3 from" [ 1 2 -1 ] "point3 to" [ 0 0 0 ])"}) {
        SCOPED_TRACE(light);
        expect_agreement({light + floor_and_wall + ball}, true);
    }
    const std::string sphere = R"(Translate .4 1.5 0 Shape "sphere" "float radius" .2)";
    for (
        const std::string& light :
        {R"(AreaLightSource "diffuse" "blackbody L" 3000 "float scale" 9 )" + sphere,
         R"(AreaLightSource "diffuse" "rgb L" [ 9 8 7 ] )" + sphere + R"( "float alpha" .5)",
         R"(AreaLightSource "diffuse" "rgb L" [ 9 8 7 ] )" + sphere + R"( "float alpha" 0)",
         std::string(
             R"(AreaLightSource "diffuse" "rgb L" [ 4 5 6 ] "bool twosided" true Translate .3 1.5 0 Rotate 60 0 1 1
             Shape "disk" "float radius" .3)")}) {
        SCOPED_TRACE(light);
        expect_agreement({"AttributeBegin " + light + " AttributeEnd" + floor_and_wall + ball}, true);
    }
    expect_agreement({R"(LightSource "infinite" "rgb L" [ .5 .5 .6 ])" + floor_and_wall + ball}, false);
}

TEST(LightTracing, SeveralLightsInBothColorModes) {
    const std::string world = R"(LightSource "infinite" "rgb L" [ .1 .1 .2 ]
LightSource "point" "rgb I" [ 1 .8 .6 ] "point3 from" [ .3 1.5 -.3 ])" +
                              lamp + floor_and_wall + ball;
    expect_agreement({world, perspective, ColorMode::rgb}, false);
    expect_agreement({world, perspective, ColorMode::spectral}, false);
}

TEST(LightTracing, GlassThatDispersesAndRoughMetal) {
    const std::string world = lamp + floor_and_wall + R"(
Material "dielectric" "spectrum eta" "glass-SF11"
Translate -.5 .5 0
Shape "sphere" "float radius" .4
Material "conductor" "float roughness" .2
Translate 1 0 0
Shape "sphere" "float radius" .4
)";
    expect_agreement({world, perspective, ColorMode::spectral}, false);
}

TEST(LightTracing, ShadingNormals) {
    expect_agreement({lamp + floor_and_wall + octahedron}, true);
    expect_agreement({lamp + floor_and_wall + R"(Material "conductor" "float roughness" .5)" + octahedron},
                     true);
    expect_agreement({lamp + floor_and_wall + R"(Material "dielectric" "float roughness" .4)" + octahedron},
                     false);
}

TEST(LightTracing, BordersOfMediaAreNotThere) {
    expect_agreement({lamp + floor_and_wall + R"(Material "interface")" + ball + R"(
Material "interface"
AreaLightSource "diffuse" "rgb L" [ 1 2 1 ]
Translate .2 .4 -.2
Shape "sphere" "float radius" .2
)"},
                     true);
}

TEST(LightTracing, PartsOfThePicture) {
    expect_agreement({lamp + floor_and_wall + ball, perspective, ColorMode::rgb, Rect2i{{2, 3}, {6, 8}}},
                     true);
}

// Where neither the lens nor the light is too small for it, every strategy finds all there is.
void expect_same_strategies(const Setting& setting) {
    const std::string text =
        scene_text(R"("bdpt" "integer maxdepth" 3 "bool visualizestrategies" true)", 100, setting);
    std::map<std::string, std::vector<double>> means;
    for (int seed = 0; seed < t_test_seeds; ++seed) {
        Messages messages;
        auto world = build_world(read_pbrt_string(text, ".", messages), settings_of(setting, seed), messages);
        render(*world, settings_of(setting, seed), {});
        const auto names = world->integrator->splat_layers();
        ASSERT_EQ(names.size(), 2u + 3 + 4 + 5 - 1);
        for (std::size_t i = 0; i < names.size(); ++i)
            means[names[i]].push_back(mean_of_colors(world->film->splat_image(i + 1)));
    }
    for (const char* depth : {"1", "2", "3"}) {
        const auto& reference = means[fmt::format("bdpt_d0{}_s01_t0{}", depth, std::stoi(depth) + 1)];
        ASSERT_GT(moments(reference).mean, 1e-3);
        for (const auto& [name, values] : means) {
            if (name.find(std::string("d0") + depth) == std::string::npos) continue;
            EXPECT_LT(std::abs(t_between(values, reference, 1e-3)), t_test_limit) << name;
        }
    }
}

TEST(Bidirectional, EachStrategyAloneFindsTheSame) {
    expect_same_strategies({lamp + floor_and_wall + R"(Material "conductor" "float roughness" .6)" + ball});
    expect_same_strategies({lamp + floor_and_wall + octahedron, R"(Camera "perspective" "float fov" 30)"});
}

TEST(Bidirectional, WeighedStrategiesAddUpToThePicture) {
    const Setting setting{lamp + floor_and_wall + ball, perspective, ColorMode::spectral,
                          Rect2i{{1, 2}, {9, 7}}};
    const std::string text =
        scene_text(R"("bdpt" "integer maxdepth" 3 "bool visualizeweights" true)", 64, setting);
    Messages messages;
    auto world = build_world(read_pbrt_string(text, ".", messages), settings_of(setting, 1), messages);
    render(*world, settings_of(setting, 1), {});
    double sum = 0;
    for (std::size_t i = 1; i <= world->integrator->splat_layers().size(); ++i)
        sum += mean_of_colors(world->film->splat_image(i));
    // Layers lose what the filter spreads over the border.
    EXPECT_NEAR(sum / mean_of_colors(world->film->image()), 1, 0.1);
}

TEST(Bidirectional, ShowsStrategiesOfShortPathsOnly) {
    Messages messages;
    auto world = build_world(
        read_pbrt_string(scene_text(R"("bdpt" "integer maxdepth" 9 "bool visualizeweights" true)", 1, {lamp}),
                         ".", messages),
        {}, messages);
    EXPECT_EQ(world->integrator->splat_layers().size(), 26u);
    ASSERT_EQ(messages.warnings().size(), 1u);
    EXPECT_NE(messages.warnings()[0].text.find("limits \"maxdepth\" to 5"), std::string::npos);
}

/// Means of a picture's upper and lower half.
struct Halves {
    std::vector<double> upper, lower;
};

Halves halves_of(const std::string& integrator, int spp, const Setting& setting) {
    Halves halves;
    for (int seed = 0; seed < t_test_seeds; ++seed) {
        const Image image =
            render_text(scene_text(integrator, spp, setting), settings_of(setting, seed)).image;
        double sums[2] = {0, 0};
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x)
                for (int c = 0; c < 3; ++c)
                    sums[2 * y / image.height()] += static_cast<double>(image.rgb(x, y)[c]);
        halves.upper.push_back(sums[0]);
        halves.lower.push_back(sums[1]);
    }
    return halves;
}

void expect_same_halves(const Halves& a, const Halves& b, double floor) {
    EXPECT_LT(std::abs(t_between(a.upper, b.upper, floor)), t_test_limit);
    EXPECT_LT(std::abs(t_between(a.lower, b.lower, floor)), t_test_limit);
}

// Chains keep to where it is bright; the picture must not.
TEST(Metropolis, IsThePathTracersPicture) {
    const std::string mlt =
        R"("mlt" "integer maxdepth" 3 "integer bootstrapsamples" 4000 "integer chains" 30)";
    const std::string glossy = R"(Material "conductor" "float roughness" .3)" + ball;
    const std::string sky = R"(LightSource "infinite" "rgb L" [ .1 .1 .2 ])";
    for (const Setting& setting :
         {Setting{lamp + floor_and_wall + glossy, perspective, ColorMode::spectral},
          Setting{sky + lamp + floor_and_wall + ball, R"(Camera "perspective" "float lensradius" .1)"},
          Setting{lamp + floor_and_wall + ball, perspective, ColorMode::rgb, Rect2i{{2, 1}, {8, 7}}}})
        expect_same_halves(halves_of(mlt, 64, setting),
                           halves_of(R"("path" "integer maxdepth" 3)", 64, setting), 1e-4);
}

TEST(Metropolis, DarkScenesStayDark) {
    const Setting setting{floor_and_wall};
    const Image image = render_text(scene_text(R"("mlt" "integer bootstrapsamples" 100)", 2, setting)).image;
    EXPECT_EQ(mean_of_colors(image), 0);
}

// Photons are gathered from around: with a small radius the blur is well below the 0.3 % that are granted
// beside the noise.
TEST(PhotonMapping, IsThePathTracersPicture) {
    const std::string sppm =
        R"("sppm" "integer maxdepth" 12 "integer photonsperiteration" 1000 "float radius" .12)";
    const std::string mirrors = R"(
Material "phong" "rgb diffuse" [ .3 .4 .3 ] "float reflectivity" .5
Shape "bilinearmesh" "point3 P" [ -2 0 -2  2 0 -2  -2 0 1  2 0 1 ]
Material "conductor" "float roughness" .3
Shape "bilinearmesh" "point3 P" [ -2 0 1  2 0 1  -2 3 1  2 3 1 ]
Material "diffuse" "rgb reflectance" [ .7 .6 .5 ])" +
                                ball;
    for (const Setting& setting : {Setting{lamp + floor_and_wall + ball, perspective, ColorMode::spectral},
                                   Setting{R"(LightSource "infinite" "rgb L" [ .2 .2 .3 ])" + lamp + mirrors},
                                   Setting{lamp + floor_and_wall + ball,
                                           R"(Camera "orthographic" "float screenwindow" [ -.8 .8 -.8 1.2 ])",
                                           ColorMode::rgb, Rect2i{{2, 1}, {8, 7}}}})
        expect_same_halves(halves_of(sppm, 16, setting),
                           halves_of(R"("path" "integer maxdepth" 12)", 64, setting), 3e-3);
}

// A mirror that is matte, too, all around: nearly all light has been there and back several times.
TEST(PhotonMapping, SharesSurfacesWithMirrors) {
    const Setting setting{R"(
AreaLightSource "diffuse" "rgb L" [ .5 .5 .5 ]
Material "phong" "rgb diffuse" [ .8 .7 .6 ] "rgb specular" [ 0 0 0 ] "float reflectivity" .4
ReverseOrientation
Shape "sphere" "float radius" 5
)"};
    expect_same_halves(
        halves_of(R"("sppm" "integer maxdepth" 15 "integer photonsperiteration" 4000 "float radius" .3)", 8,
                  setting),
        halves_of(R"("path" "integer maxdepth" 15)", 16, setting), 2e-3);
}

// A point light through a ball of glass that disperses: the floor's caustic, which paths can only bring from
// the light.
TEST(LightTracing, Caustics) {
    Setting setting{R"(LightSource "point" "rgb I" [ 2 2 2 ] "point3 from" [ 0 3 0 ]
Material "diffuse" "rgb reflectance" [ .7 .7 .7 ]
Shape "bilinearmesh" "point3 P" [ -2 0 -2  2 0 -2  -2 0 1  2 0 1 ]
Material "dielectric" "spectrum eta" "glass-SF11"
Translate 0 1 0
Shape "sphere" "float radius" .5
)",
                    R"(PixelFilter "gaussian" "float xradius" 4 "float yradius" 4 "float sigma" 1.5
Identity LookAt 0 .4 -1.2  0 0 0  0 1 0
Camera "perspective" "float fov" 30)",
                    ColorMode::spectral};
    const std::string lightpath = R"("lightpath" "integer maxdepth" 5)";
    const Halves reference = halves_of(lightpath, 128, setting);
    expect_same_halves(halves_of(R"("bdpt" "integer maxdepth" 5)", 64, setting), reference, 1e-3);
    const std::string sppm =
        R"("sppm" "integer maxdepth" 6 "integer photonsperiteration" 3000 "float radius" .05)";
    expect_same_halves(halves_of(sppm, 16, setting), reference, 1e-2);
    // One wavelength for all: of the few chains, none shall be in a colour of its own.
    setting.mode = ColorMode::rgb;
    const std::string mlt =
        R"("mlt" "integer maxdepth" 5 "integer bootstrapsamples" 5000 "integer chains" 100)";
    expect_same_halves(halves_of(mlt, 100, setting), halves_of(lightpath, 128, setting), 1e-3);
}

TEST(LightTracing, SaysWhichCamerasItCannotUse) {
    for (const char* integrator : {"lightpath", "bdpt", "mlt"}) {
        try {
            render_text(scene_text(fmt::format("\"{}\"", integrator), 1, {lamp, R"(Camera "spherical")"}));
            FAIL();
        } catch (const SceneError& error) {
            EXPECT_NE(std::string(error.what()).find("not possible with camera \"spherical\""),
                      std::string::npos);
        }
    }
}

} // namespace
} // namespace alhazen::testing
