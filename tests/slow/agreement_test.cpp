/// Integrators agree: on scenes that no formula gives, the path tracer, the same with other light samplers,
/// the simple path tracers and those that follow light from the lamps converge to one mean. Welch's t-test
/// over 16 seeds each, |t| < 7: a false-alarm rate of about 4e-6 a comparison; fixed seeds.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/render_scene.h"
#include "tests/support/statistics.h"

namespace alhazen::testing {
namespace {

/// What a scene has, as a set of bits; a method may not see all of it.
enum Sight { small_lights = 1, sky = 2 };

struct Method {
    std::string name, integrator;
    int spp;
    int blind_to = 0;
};

const std::vector<Method>& methods() {
    static const std::vector<Method> list{
        {"path bvh", R"(Integrator "path" "integer maxdepth" 4)", 32},
        {"path uniform", R"(Integrator "path" "integer maxdepth" 4 "string lightsampler" "uniform")", 32},
        {"path power", R"(Integrator "path" "integer maxdepth" 4 "string lightsampler" "power")", 32},
        {"path with early roulette", R"(Integrator "path" "integer maxdepth" 4 "float roulettethreshold" 1)",
         32},
        {"path without roulette", R"(Integrator "path" "integer maxdepth" 4 "float roulettethreshold" 0)",
         32},
        {"simplepath", R"(Integrator "simplepath" "integer maxdepth" 4)", 64},
        {"simplepath without light sampling",
         R"(Integrator "simplepath" "integer maxdepth" 4 "bool samplelights" false)", 256, small_lights},
        {"simplepath uniform directions",
         R"(Integrator "simplepath" "integer maxdepth" 4 "bool samplebsdf" false)", 256, small_lights},
        {"randomwalk", R"(Integrator "randomwalk" "integer maxdepth" 4)", 512, small_lights},
        {"bdpt", R"(Integrator "bdpt" "integer maxdepth" 4)", 16},
        {"lightpath", R"(Integrator "lightpath" "integer maxdepth" 4)", 64, sky},
    };
    return list;
}

std::vector<double> means_of(const Method& method, const std::string& world, ColorMode mode) {
    std::string text = method.integrator +
                       fmt::format(R"(
Sampler "independent" "integer pixelsamples" {}
PixelFilter "box"
Film "rgb" "integer xresolution" 12 "integer yresolution" 12
LookAt 0 1 -3.4  0 .9 0  0 1 0
Camera "perspective" "float fov" 36
WorldBegin
)",
                                   method.spp) +
                       world;
    std::vector<double> means;
    for (int seed = 0; seed < t_test_seeds; ++seed) {
        RenderSettings settings;
        settings.seed = static_cast<std::uint64_t>(seed);
        settings.color = mode;
        Image image = render_text(text, settings).image;
        means.push_back((mean_of(image, 0) + mean_of(image, 1) + mean_of(image, 2)) / 3);
    }
    return means;
}

const char* const room = R"(
Material "diffuse" "rgb reflectance" [ .7 .6 .5 ]
Shape "bilinearmesh" "point3 P" [ -1 0 -1  1 0 -1  -1 0 1  1 0 1 ]
Shape "bilinearmesh" "point3 P" [ -1 0 1  1 0 1  -1 2 1  1 2 1 ]
Material "diffuse" "rgb reflectance" [ .2 .6 .2 ]
Shape "bilinearmesh" "point3 P" [ -1 0 -1  -1 0 1  -1 2 -1  -1 2 1 ]
)";

void expect_agreement(const std::string& world, ColorMode mode, int sights) {
    std::vector<double> reference = means_of(methods().front(), world, mode);
    ASSERT_GT(moments(reference).mean, 0.01);
    for (std::size_t i = 1; i < methods().size(); ++i) {
        const Method& method = methods()[i];
        if (method.blind_to & sights) continue;
        EXPECT_LT(std::abs(t_between(means_of(method, world, mode), reference, 1e-4)), t_test_limit)
            << method.name;
    }
}

TEST(Agreement, AreaLightInARoom) {
    std::string world = std::string(room) + R"(
AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 6 5 4 ] "bool twosided" true
Shape "bilinearmesh" "point3 P" [ -.5 1.9 -.5  .5 1.9 -.5  -.5 1.9 .5  .5 1.9 .5 ]
AttributeEnd
Translate 0 .4 0
Material "conductor" "float roughness" .5
Shape "sphere" "float radius" .4
)";
    expect_agreement(world, ColorMode::rgb, 0);
    expect_agreement(world, ColorMode::spectral, 0);
}

TEST(Agreement, SphereLightAndSky) {
    std::string world = std::string(room) + R"(
LightSource "infinite" "rgb L" [ .2 .3 .5 ]
AttributeBegin
AreaLightSource "diffuse" "blackbody L" 3000 "float scale" 3
Translate .3 1.2 .1
Shape "sphere" "float radius" .3
AttributeEnd
Translate -.2 .4 0
Material "dielectric" "float roughness" .4
Shape "sphere" "float radius" .4
)";
    expect_agreement(world, ColorMode::rgb, sky);
    expect_agreement(world, ColorMode::spectral, sky);
}

TEST(Agreement, PointSpotAndDistantLights) {
    std::string world = std::string(room) + R"(
LightSource "point" "rgb I" [ 1 .8 .6 ] "point3 from" [ .3 1.5 -.3 ]
LightSource "spot" "rgb I" [ 2 3 4 ] "point3 from" [ -.5 1.8 -.5 ] "point3 to" [ .2 0 .2 ] "float coneangle" 40
LightSource "distant" "rgb L" [ .4 .4 .3 ] "point3 from" [ 1 2 -1 ] "point3 to" [ 0 0 0 ]
Material "phong" "rgb diffuse" [ .4 .2 .2 ] "rgb specular" [ .4 .4 .4 ] "float shininess" 20
Translate 0 .4 0
Shape "sphere" "float radius" .4
)";
    expect_agreement(world, ColorMode::rgb, small_lights);
}

} // namespace
} // namespace alhazen::testing
