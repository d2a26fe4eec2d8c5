/// What scenes mean where they are silent: what pbrt-v4 takes them to mean.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/render_scene.h"

namespace alhazen::testing {
namespace {

using ::testing::HasSubstr;

const std::string few_pixels = R"(
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
LookAt 0 0 -4  0 0 0  0 1 0
Camera "perspective" "float fov" 20
)";

TEST(SilentScenes, AreRenderedByAnIntegratorThatSeesMedia) {
    const std::string text = few_pixels + R"(
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
MakeNamedMedium "dark" "string type" "homogeneous" "rgb sigma_a" [ 1 1 1 ] "rgb sigma_s" [ 0 0 0 ]
MediumInterface "dark" ""
Material "interface"
Shape "sphere" "float radius" 1
)";
    RenderSettings settings;
    const double silent = mean_of(render_text(text, settings).image, 0);
    settings.integrator = "volpath";
    EXPECT_EQ(mean_of(render_text(text, settings).image, 0), silent);
    settings.integrator = "path";
    EXPECT_GT(mean_of(render_text(text, settings).image, 0), 1.2 * silent);
}

TEST(SilentScenes, BordersOfMediaDoNotGlow) {
    const std::string text = few_pixels + R"(
WorldBegin
AreaLightSource "diffuse"
Material "interface"
Shape "sphere"
)";
    Messages messages;
    auto world = build_world(read_pbrt_string(text, ".", messages), {}, messages);
    ASSERT_EQ(messages.list().size(), 1u);
    EXPECT_THAT(messages.list().front().text, HasSubstr("cannot be an area light; it is dark"));
    render(*world, {}, {});
    EXPECT_EQ(mean_of(world->film->image(), 0), 0);
    EXPECT_TRUE(world->scene->lights().empty());
}

// A light without a colour has the white of the colour space it stands in.
TEST(SilentScenes, LightsAreWhiteInTheirColorSpace) {
    const std::string floor = R"(
Translate 0 0 2
Shape "disk" "float radius" 5
)";
    struct Silent {
        const char *light, *color;
    };
    for (auto [light, color] : {Silent{"LightSource \"infinite\"", "L"},
                                Silent{"LightSource \"point\" \"point3 from\" [ 1 0 -3 ]", "I"},
                                Silent{"LightSource \"distant\"", "L"},
                                Silent{"LightSource \"spot\" \"point3 from\" [ 0 0 -3 ]", "I"},
                                Silent{"AreaLightSource \"diffuse\" \"bool twosided\" true", "L"}}) {
        SCOPED_TRACE(light);
        auto mean = [&](const std::string& space, const std::string& given) {
            RenderSettings settings;
            settings.color = ColorMode::rgb;
            const Image image = render_text(few_pixels + "WorldBegin\nAttributeBegin\n" + space + light +
                                                given + floor + "AttributeEnd\n",
                                            settings)
                                    .image;
            return std::array{mean_of(image, 0), mean_of(image, 2)};
        };
        const std::string aces = "ColorSpace \"aces2065-1\"\n";
        const std::string white = std::string(" \"rgb ") + color + "\" [ 1 1 1 ]";
        const auto silent = mean(aces, "");
        EXPECT_GT(silent[0], 1.05 * silent[1]); // D60 is warmer than D65
        EXPECT_EQ(silent, mean(aces, white));
        EXPECT_EQ(mean("", ""), mean("", white));
    }
}

} // namespace
} // namespace alhazen::testing
