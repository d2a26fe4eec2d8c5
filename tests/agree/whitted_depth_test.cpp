/// Whitted's tree of rays where scenes made for path tracing ask for great depths.
#include <gtest/gtest.h>

#include "tests/support/render_scene.h"

namespace alhazen::testing {
namespace {

// Panes of glass one behind the other: each surface splits the ray, and the whole tree has 2^depth rays.
Rendered panes(int depth, bool is_instance) {
    std::string text = R"(
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
Integrator "whitted" "integer maxdepth" )" +
                       std::to_string(depth) + R"(
LookAt 0 .2 -6  0 0 0  0 1 0
Camera "perspective" "float fov" 30
WorldBegin
LightSource "infinite" "rgb L" [ .7 .8 .9 ]
Material "diffuse" "rgb reflectance" [ .8 .4 .2 ]
Shape "sphere" "float radius" .5
Material "dielectric"
)";
    if (is_instance) text += "ObjectBegin \"panes\"\n";
    for (int i = 0; i < 12; ++i)
        text += "AttributeBegin\nTranslate 0 0 " + std::to_string(-2 - .1 * i) +
                "\nShape \"trianglemesh\" \"point3 P\" [ -4 -4 0  4 -4 0  4 4 0  -4 4 0 ] \"integer "
                "indices\" [ 0 "
                "1 2 0 2 3 ]\nAttributeEnd\n";
    if (is_instance) text += "ObjectEnd\nObjectInstance \"panes\"\n";
    RenderSettings settings;
    settings.spp = 1;
    return render_text(text, settings);
}

TEST(WhittedDepth, RaysThatCannotBeSeenAreNotFollowed) {
    for (bool is_instance : {false, true}) {
        const Rendered deep = panes(60, is_instance), deeper = panes(100, is_instance);
        // 64 pixels; the whole tree of one would have 2^60.
        EXPECT_LT(deep.stats.rays.bounce, 64u * 5000u);
        EXPECT_GT(deep.stats.rays.bounce, 64u * 100u);
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x)
                for (int c = 0; c < 3; ++c) {
                    EXPECT_NEAR(deep.image.rgb(x, y)[c], deeper.image.rgb(x, y)[c], 1e-4f);
                    EXPECT_GT(deep.image.rgb(x, y)[c], 0.05f);
                }
    }
}

// To eight surfaces every ray counts.
TEST(WhittedDepth, ShallowTreesAreWhole) {
    const Rendered seven = panes(7, false), eight = panes(8, false), nine = panes(9, false);
    EXPECT_GT(eight.stats.rays.bounce, seven.stats.rays.bounce * 3 / 2);
    EXPECT_GT(nine.stats.rays.bounce, eight.stats.rays.bounce);
    EXPECT_LT(nine.stats.rays.bounce, eight.stats.rays.bounce * 3 / 2);
}

} // namespace
} // namespace alhazen::testing
