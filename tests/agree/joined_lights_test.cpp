/// Triangles that make up one lamp, and are sampled as one.
#include <gtest/gtest.h>

#include "tests/support/render_scene.h"

namespace alhazen::testing {
namespace {

// A floor under a square lamp of side 2 at height 2; the lamp's directive and shapes are given.
std::string floor_under(const std::string& lamp) {
    return R"(
        Integrator "path" "integer maxdepth" 1
        Film "rgb" "integer xresolution" 8 "integer yresolution" 8
        LookAt 0 0 1  0 0 0  0 1 0
        Camera "perspective" "float fov" 60
        WorldBegin
        Material "diffuse" "float reflectance" 0.5
        Shape "disk" "float radius" 9
    )" + lamp;
}
std::string lamp_of(const std::string& parameters, bool in_two_shapes) {
    const std::string light = "AreaLightSource \"diffuse\" " + parameters + "\n";
    const std::string corners = " \"point3 P\" [ -1 -1 2  -1 1 2  1 1 2  1 -1 2 ]\n";
    auto mesh = [&](const std::string& indices) {
        return "Shape \"trianglemesh\" \"integer indices\" [ " + indices + " ]" + corners;
    };
    return light + (in_two_shapes ? mesh("0 1 2") + mesh("0 2 3") : mesh("0 1 2 0 2 3"));
}

std::size_t lights_in(const std::string& text) {
    Messages messages;
    const auto world =
        build_world(read_pbrt_string(text, ALHAZEN_SOURCE_DIR "/scenes", messages), {}, messages);
    return world->scene->lights().size();
}

TEST(JoinedLights, ALampOfTwoTrianglesIsOneLight) {
    EXPECT_EQ(lights_in(floor_under(lamp_of("\"rgb L\" [ 1 2 3 ]", false))), 1u);
    EXPECT_EQ(lights_in(floor_under(lamp_of("\"rgb L\" [ 1 2 3 ]", true))), 2u);
    // Each triangle has the flux that "power" says.
    EXPECT_EQ(lights_in(floor_under(lamp_of("\"float power\" 100", false))), 2u);
    EXPECT_EQ(lights_in(floor_under(lamp_of("\"float power\" -1", false))), 1u);
}

TEST(JoinedLights, GiveTheLightOfBothTriangles) {
    RenderSettings settings;
    settings.spp = 256;
    for (const char* parameters :
         {"\"rgb L\" [ 1 2 3 ]", "\"rgb L\" [ 1 2 3 ] \"bool twosided\" true", "\"float power\" 100"}) {
        SCOPED_TRACE(parameters);
        const Image one = render_text(floor_under(lamp_of(parameters, false)), settings).image;
        const Image two = render_text(floor_under(lamp_of(parameters, true)), settings).image;
        // 16384 samples, which differ by less than half of their mean: a standard deviation below 0.004.
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean_of(one, c) / mean_of(two, c), 1, 0.02);
        EXPECT_GT(mean_of(one, 1), 0);
    }
}

} // namespace
} // namespace alhazen::testing
