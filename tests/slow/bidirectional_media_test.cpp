/// Bidirectional paths through participating media are the path tracer's: in every kind of medium, with the
/// camera, lights and surfaces inside and outside, and by each strategy alone. Welch's t-test over 16 seeds
/// each, |t| < 5: a false-alarm rate of about 4e-5 a comparison; fixed seeds.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/lit_room.h"
#include "tests/support/render_scene.h"
#include "tests/support/statistics.h"

namespace alhazen::testing {
namespace {

constexpr double limit = 5;

struct Setting {
    std::string world;
    ColorMode mode = ColorMode::rgb;
    std::string camera_medium = {};
    std::string camera = R"(Camera "perspective" "float fov" 26)";
};

std::string scene_text(const std::string& integrator, int spp, const Setting& setting) {
    return fmt::format(R"(Integrator {}
Sampler "independent" "integer pixelsamples" {}
Film "rgb" "integer xresolution" 8 "integer yresolution" 6
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ .05 .05 .05 ] "rgb sigma_s" [ .4 .4 .4 ] "float g" .3
MakeNamedMedium "tinted" "string type" "homogeneous" "rgb sigma_a" [ .1 .3 .9 ] "rgb sigma_s" [ 3 1 .2 ] "float g" -.4
MakeNamedMedium "grid" "string type" "uniformgrid" "integer nx" 2 "integer nz" 2 "float density" [ 1 5 3 0 ]
    "rgb sigma_a" [ .2 .2 .4 ] "rgb sigma_s" [ 1 .5 1 ] "rgb Le" [ .5 .3 .2 ] "point3 p0" [ -.6 .2 -.6 ] "point3 p1" [ .6 1.4 .6 ]
MakeNamedMedium "colors" "string type" "rgbgrid" "integer nx" 2 "rgb sigma_s" [ 1 2 3 3 .1 1 ]
    "rgb sigma_a" [ .1 0 .3 0 .2 0 ] "point3 p0" [ -.6 .2 -.6 ] "point3 p1" [ .6 1.4 .6 ]
LookAt 0 1 -3.4  0 .8 0  0 1 0
MediumInterface "" "{}"
{}
WorldBegin
MediumInterface "" ""
{})",
                       integrator, spp, setting.camera_medium, setting.camera, setting.world);
}

/// Means over the picture's left and right half, of all colours, and of red and blue by themselves.
using Features = std::array<std::vector<double>, 4>;

void add_features(Features& features, const Image& image) {
    std::array<double, 4> sums{};
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const Vec3 c = image.rgb(x, y);
            const auto red = static_cast<double>(c.x), blue = static_cast<double>(c.z);
            sums[2 * x < image.width() ? 0 : 1] += red + static_cast<double>(c.y) + blue;
            sums[2] += red;
            sums[3] += blue;
        }
    for (std::size_t i = 0; i < 4; ++i) features[i].push_back(sums[i] / (image.width() * image.height()));
}

RenderSettings settings_of(const Setting& setting, int seed) {
    RenderSettings settings;
    settings.seed = static_cast<std::uint64_t>(seed);
    settings.color = setting.mode;
    return settings;
}

Features features_of(const std::string& integrator, int spp, const Setting& setting) {
    Features features;
    for (int seed = 0; seed < t_test_seeds; ++seed)
        add_features(features,
                     render_text(scene_text(integrator, spp, setting), settings_of(setting, seed)).image);
    return features;
}

void expect_same(const Features& a, const Features& b, double floor) {
    for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_GT(moments(b[i]).mean, 1e-3);
        EXPECT_LT(std::abs(t_between(a[i], b[i], floor)), limit)
            << "feature " << i << ": " << moments(a[i]).mean << " +- "
            << std::sqrt(moments(a[i]).variance_of_mean) << ", not " << moments(b[i]).mean << " +- "
            << std::sqrt(moments(b[i]).variance_of_mean);
    }
}

void expect_agreement(const Setting& setting) {
    const std::string depth = R"( "integer maxdepth" 4)";
    const Features reference = features_of("\"volpath\"" + depth, 128, setting);
    expect_same(features_of("\"bdpt\"" + depth, 64, setting), reference, 1e-3);
}

std::string ball(const std::string& inside, const std::string& outside = "",
                 const std::string& material = "\"interface\"") {
    return fmt::format(R"(
AttributeBegin
Material {}
MediumInterface "{}" "{}"
Translate 0 .8 0
Shape "sphere" "float radius" .6
AttributeEnd
)",
                       material, inside, outside);
}

TEST(BidirectionalMedia, EveryMediumInBothColorModes) {
    for (const char* medium : {"fog", "tinted", "grid", "colors"})
        for (const ColorMode mode : {ColorMode::rgb, ColorMode::spectral}) {
            SCOPED_TRACE(fmt::format("{} {}", medium, static_cast<int>(mode)));
            expect_agreement({lamp + floor_and_wall + ball(medium), mode});
        }
}

TEST(BidirectionalMedia, CameraAndLightsInside) {
    const std::string in_fog = R"(MediumInterface "fog" "fog")";
    for (const ColorMode mode : {ColorMode::rgb, ColorMode::spectral}) {
        expect_agreement({in_fog + lamp + floor_and_wall, mode, "fog"});
        expect_agreement({in_fog + lamp + floor_and_wall + ball("tinted", "fog"), mode, "fog"});
    }
    // A point light and a lamp in a ball of another medium, seen through a lens.
    expect_agreement(
        {R"(LightSource "point" "rgb I" [ 1 .8 .6 ] "point3 from" [ .1 .9 -.1 ]
AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 6 5 4 ]
Translate .2 .6 0
Shape "sphere" "float radius" .15
AttributeEnd
)" + floor_and_wall +
             ball("tinted", "fog"),
         ColorMode::rgb, "fog",
         R"(Camera "perspective" "float fov" 26 "float lensradius" .1 "float focaldistance" 3)"});
}

TEST(BidirectionalMedia, LightsThatAreFarAway) {
    const std::string sky = R"(LightSource "infinite" "rgb L" [ .5 .5 .6 ])";
    const std::string sun =
        R"(LightSource "distant" "rgb L" [ .8 .7 .5 ] "point3 from" [ 1 2 -1 ] "point3 to" [ 0 0 0 ])";
    expect_agreement({sky + floor_and_wall + ball("grid"), ColorMode::spectral});
    expect_agreement({sky + sun + floor_and_wall + ball("tinted")});
}

TEST(BidirectionalMedia, GlassAndSurfacesInside) {
    const std::string core = R"(
AttributeBegin
Material "conductor" "float roughness" .3
Translate 0 .8 0
Shape "sphere" "float radius" .3
AttributeEnd
)";
    expect_agreement({lamp + floor_and_wall + ball("tinted") + core, ColorMode::spectral});
    expect_agreement({lamp + floor_and_wall + ball("tinted", "", R"("dielectric" "float roughness" .3)")});
    expect_agreement(
        {lamp + floor_and_wall +
             ball("tinted", "", R"("dielectric" "float roughness" .3 "spectrum eta" "glass-SF11")"),
         ColorMode::spectral});
}

TEST(BidirectionalMedia, EachStrategyAloneFindsTheSame) {
    const Setting setting{lamp + floor_and_wall + ball("tinted", "fog"), ColorMode::rgb, "fog"};
    const std::string text =
        scene_text(R"("bdpt" "integer maxdepth" 3 "bool visualizestrategies" true)", 150, setting);
    std::map<std::string, Features> found;
    for (int seed = 0; seed < t_test_seeds; ++seed) {
        Messages messages;
        auto world = build_world(read_pbrt_string(text, ".", messages), settings_of(setting, seed), messages);
        EXPECT_TRUE(messages.warnings().empty());
        render(*world, settings_of(setting, seed), {});
        const auto names = world->integrator->splat_layers();
        for (std::size_t i = 0; i < names.size(); ++i)
            add_features(found[names[i]], world->film->splat_image(i + 1));
    }
    for (const char* depth : {"1", "2", "3"}) {
        const Features& reference = found[fmt::format("bdpt_d0{}_s01_t0{}", depth, std::stoi(depth) + 1)];
        for (const auto& [name, features] : found) {
            if (name.find(std::string("d0") + depth) == std::string::npos) continue;
            SCOPED_TRACE(name);
            expect_same(features, reference, 1e-3);
        }
    }
}

// Chains keep to where it is bright; the picture must not.
TEST(MetropolisMedia, IsThePathTracersPicture) {
    const std::string mlt =
        R"("mlt" "integer maxdepth" 4 "integer bootstrapsamples" 4000 "integer chains" 30)";
    for (const Setting& setting :
         {Setting{lamp + floor_and_wall + ball("tinted"), ColorMode::spectral},
          Setting{lamp + floor_and_wall + ball("grid")},
          Setting{R"(MediumInterface "fog" "fog")" + lamp + floor_and_wall, ColorMode::rgb, "fog"},
          Setting{R"(LightSource "infinite" "rgb L" [ .5 .5 .6 ])" + floor_and_wall + ball("colors")}})
        expect_same(features_of(mlt, 64, setting),
                    features_of(R"("volpath" "integer maxdepth" 4)", 128, setting), 1e-3);
}

} // namespace
} // namespace alhazen::testing
