/// Borders between media change nothing where there are no media: they are seen through, by every integrator
/// and every kind of ray.
#include <gtest/gtest.h>

#include "tests/support/render_scene.h"

namespace alhazen::testing {
namespace {

const std::string seen_from_front = R"(
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
LookAt 0 1.5 -3  0 0 0  0 1 0
Camera "perspective" "float fov" 40
)";

double mean_red(const std::string& integrator, const std::string& world, int maxdepth, int spp = 64) {
    RenderSettings settings;
    settings.color = ColorMode::rgb;
    settings.spp = spp;
    settings.integrator = integrator;
    settings.overrides = {"integrator.maxdepth=" + std::to_string(maxdepth)};
    return mean_of(render_text(seen_from_front + "WorldBegin\n" + world, settings).image, 0);
}

const std::string floor_below = R"(
Material "diffuse" "rgb reflectance" [ .5 .5 .5 ]
AttributeBegin
Rotate 90 1 0 0
Shape "disk" "float radius" 6
AttributeEnd
)";
const std::string all_around = R"(
Material "interface"
Shape "sphere" "float radius" 7
)";

// Half of the points of what stands before the lamp are black, the others nothing.
TEST(Borders, InMixturesLetHalfOfTheLightThrough) {
    const std::string lamp_and_floor = floor_below + R"(
AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 5 5 5 ]
Translate 0 3 0
Rotate 90 1 0 0
Shape "disk" "float radius" 1
AttributeEnd
MakeNamedMaterial "nothing" "string type" "interface"
MakeNamedMaterial "black" "string type" "diffuse" "rgb reflectance" [ 0 0 0 ]
MakeNamedMaterial "half" "string type" "mix" "string materials" [ "black" "nothing" ]
)";
    const std::string disk = "Translate 0 2 0\nRotate 90 1 0 0\nShape \"disk\" \"float radius\" 5\n";
    // Triangles go another way through the structures than disks.
    const std::string mesh = R"(
Translate 0 2 0
Shape "trianglemesh" "point3 P" [ -5 0 -5  5 0 -5  5 0 5  -5 0 5 ] "integer indices" [ 0 1 2  0 2 3 ]
)";
    const double bare = mean_red("path", lamp_and_floor + "NamedMaterial \"nothing\"\n" + disk, 1);
    EXPECT_GT(bare, 0.1);
    for (const std::string& shape : {disk, mesh}) {
        const std::string world = lamp_and_floor + "NamedMaterial \"half\"\n" + shape;
        for (const char* integrator : {"path", "volpath", "bdpt", "sppm", "simplepath"})
            EXPECT_NEAR(mean_red(integrator, world, 1), bare / 2, 0.02 * bare) << integrator;
        EXPECT_NEAR(mean_red("lightpath", world, 1, 1024), bare / 2, 0.05 * bare);
    }
}

TEST(Borders, BeyondAPortalLetItsLightThrough) {
    const std::string window = floor_below + R"(
LightSource "infinite" "rgb L" [ 5 5 5 ] "point3 portal" [ -1 3 -1  1 3 -1  1 3 1  -1 3 1 ]
)";
    for (const char* integrator : {"path", "volpath", "bdpt", "sppm"}) {
        const double bare = mean_red(integrator, window, 1);
        EXPECT_GT(bare, 0.1);
        EXPECT_NEAR(mean_red(integrator, window + all_around, 1), bare, 1e-3 * bare) << integrator;
    }
    // These find the window by chance: the same paths, with a border more.
    for (const char* integrator : {"simplevolpath", "randomwalk"}) {
        const double bare = mean_red(integrator, window, 1);
        EXPECT_GT(bare, 0.1);
        EXPECT_NEAR(mean_red(integrator, window + all_around, 1), bare, 1e-3 * bare) << integrator;
    }
}

TEST(Borders, AreSeenThroughAtAnyDepth) {
    const std::string lamp =
        "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [ 1 1 1 ]\nTranslate 0 -1 2\n"
        "Shape \"sphere\" \"float radius\" 3\nAttributeEnd\n";
    for (const char* integrator : {"randomwalk", "path", "volpath", "simplepath", "simplevolpath", "bdpt"})
        EXPECT_NEAR(mean_red(integrator, lamp + all_around, 0), mean_red(integrator, lamp, 0), 1e-6)
            << integrator;
}

TEST(Borders, DoNotOcclude) {
    RenderSettings settings;
    settings.integrator = "ambientocclusion";
    settings.color = ColorMode::rgb;
    const std::string start = seen_from_front + "WorldBegin\n";
    const double bare = mean_of(render_text(start + floor_below, settings).image, 0);
    EXPECT_GT(bare, 0.1);
    EXPECT_NEAR(mean_of(render_text(start + floor_below + all_around, settings).image, 0), bare, 1e-6);
    EXPECT_EQ(mean_of(render_text(start + all_around, settings).image, 0), 0);
}

} // namespace
} // namespace alhazen::testing
