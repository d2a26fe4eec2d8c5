/// Motion blur: the picture of what moves is the mean of the pictures of its places.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "accel/list.h"
#include "image/metrics.h"
#include "tests/support/render_scene.h"

namespace alhazen {
namespace {

using ::testing::HasSubstr;
using testing::render_text;

/// The world's parts that may move.
struct Moving {
    std::string camera, ball, cards;
};

// Text that does one thing at the start of the motion and another at its end.
std::string between(const std::string& start, const std::string& end) {
    return "ActiveTransform StartTime\n" + start + "\nActiveTransform EndTime\n" + end +
           "\nActiveTransform All\n";
}

std::string scene_of(const Moving& moving, const std::string& integrator = "path",
                     const std::string& more = "") {
    return "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 24\nIntegrator \"" + integrator +
           "\" \"integer maxdepth\" 3\nSampler \"zsobol\" \"integer pixelsamples\" 64\nTransformTimes 0 1\n" +
           more + "LookAt 0 0 -5  0 0 0  0 1 0\n" + moving.camera +
           "Camera \"perspective\" \"float fov\" 50 \"float shutteropen\" 0.25 \"float shutterclose\" 0.75\n"
           "WorldBegin\nLightSource \"infinite\" \"rgb L\" [ .4 .5 .6 ]\n"
           "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [ 9 8 7 ]\nTranslate 0 3 -1\nRotate 90 1 0 "
           "0\n"
           "Shape \"disk\" \"float radius\" .6\nAttributeEnd\n"
           "Material \"diffuse\" \"rgb reflectance\" [ .6 .5 .4 ]\n"
           "Shape \"bilinearmesh\" \"point3 P\" [ -5 -1.2 -5  5 -1.2 -5  -5 -1.2 5  5 -1.2 5 ]\n"
           "AttributeBegin\nMaterial \"diffuse\" \"rgb reflectance\" [ .8 .2 .2 ]\n" +
           moving.ball +
           "Shape \"sphere\" \"float radius\" .6\nAttributeEnd\n"
           "ObjectBegin \"card\"\nMaterial \"conductor\"\n"
           "Shape \"bilinearmesh\" \"point3 P\" [ -.5 -.5 0  .5 -.5 0  -.5 .5 0  .5 .5 0 ]\nObjectEnd\n"
           "AttributeBegin\n" +
           moving.cards + "ObjectInstance \"card\"\nTranslate 0 1 0\nObjectInstance \"card\"\nAttributeEnd\n";
}
const Moving in_motion{between("", "Translate -0.4 0 0"), between("Translate -1 0 0", "Translate 1 0 0"),
                       between("Translate 1.2 0 1", "Translate 1.2 0 1\nRotate 80 0 1 0")};
// As it is a time after the start.
Moving frozen(double t) {
    return {fmt::format("Translate {} 0 0\n", -0.4 * t), fmt::format("Translate {} 0 0\n", 2 * t - 1),
            fmt::format("Translate 1.2 0 1\nRotate {} 0 1 0\n", 80 * t)};
}

Image mean_of_places(const std::string& integrator) {
    Image mean = Image::rgb_image(32, 24);
    constexpr int count = 64;
    RenderSettings settings;
    settings.spp = 16;
    for (int i = 0; i < count; ++i) {
        settings.seed = static_cast<std::uint64_t>(i);
        const Image one =
            render_text(scene_of(frozen(0.25 + 0.5 * (i + 0.5) / count), integrator), settings).image;
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 32; ++x) mean.set_rgb(x, y, mean.rgb(x, y) + one.rgb(x, y) / float(count));
    }
    return mean;
}

TEST(Motion, PictureIsTheMeanOfThePlaces) {
    RenderSettings settings;
    settings.spp = 1024;
    for (const char* integrator : {"bdpt", "whitted"}) {
        const Image mean = mean_of_places(integrator);
        const Image moving = render_text(scene_of(in_motion, integrator), settings).image;
        // 64 places leave steps at edges; a picture that does not move is many times as far.
        EXPECT_LT(relmse(moving, mean).value, 2.5e-3) << integrator;
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(testing::mean_of(moving, c) / testing::mean_of(mean, c), 1, 0.006)
                << integrator << " " << c;
        const Image still = render_text(scene_of(frozen(0.25), integrator), settings).image;
        EXPECT_GT(relmse(still, mean).value, 1e-2) << integrator;
    }
}

TEST(Motion, IntegratorsAgree) {
    RenderSettings settings;
    settings.spp = 1024;
    const Image path = render_text(scene_of(in_motion), settings).image;
    for (const char* integrator : {"bdpt", "sppm"}) {
        const Image other = render_text(scene_of(in_motion, integrator), settings).image;
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(testing::mean_of(other, c) / testing::mean_of(path, c), 1, 0.015)
                << integrator << " " << c;
    }
}

TEST(Motion, EveryStructureGivesTheSameBits) {
    RenderSettings settings;
    settings.spp = 4;
    const Image expected = render_text(scene_of(in_motion), settings).image;
    for (const char* pair :
         {"sah/stack", "lbvh/stackless", "sbvh/cwbvh", "ploc/guthe", "sah/shortstack", "octree/stack"}) {
        const std::string name = pair;
        const std::size_t slash = name.find('/');
        const std::string accelerator =
            fmt::format("Accelerator \"bvh\" \"string builder\" \"{}\" \"string walk\" \"{}\"\n",
                        name.substr(0, slash), name.substr(slash + 1));
        const Image image = render_text(scene_of(in_motion, "path", accelerator), settings).image;
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 32; ++x) ASSERT_EQ(image.rgb(x, y), expected.rgb(x, y)) << pair;
    }
}

TEST(Motion, SaysWhatCannotMove) {
    auto error_of = [](const std::string& text) -> std::string {
        try {
            render_text(text);
        } catch (const SceneError& e) {
            return e.what();
        }
        return "no error";
    };
    EXPECT_THAT(error_of(scene_of({"", between("", "Scale -1 1 1"), ""})),
                HasSubstr("both must mirror, or neither"));
    EXPECT_THAT(error_of(scene_of({between("", "Scale -1 1 1"), "", ""})),
                HasSubstr("both must mirror, or neither"));
    EXPECT_THAT(error_of("WorldBegin\nAreaLightSource \"diffuse\"\n" + between("", "Translate 1 0 0") +
                         "Shape \"sphere\"\n"),
                HasSubstr("area lights that move are not supported"));
}

/// A ball and a light; what is told of the scene comes out in warnings.
Image lit_picture(const std::string& light, std::string& warnings) {
    const std::string text = "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 8\n"
                             "Camera \"perspective\"\nWorldBegin\n" +
                             light + "\nAttributeBegin\nTranslate 0 0 5\nShape \"sphere\"\nAttributeEnd\n";
    RenderSettings settings;
    settings.spp = 4;
    Messages messages;
    messages.lenient = true;
    auto world = build_world(read_pbrt_string(text, ".", messages), settings, messages);
    for (const Message& m : messages.list()) warnings += m.full_text() + "\n";
    render(*world, settings, {});
    return world->film->image();
}

// As in pbrt-v4, which errs where an area light moves, and is lenient here, too.
TEST(Motion, LightsStayWhereTheyAreAtTheStart) {
    for (const std::string light : {"LightSource \"point\" \"rgb I\" [ 9 9 9 ]",
                                    "AreaLightSource \"diffuse\" \"rgb L\" [ 9 9 9 ]\nShape \"sphere\""}) {
        SCOPED_TRACE(light);
        std::string still_warnings, moving_warnings;
        const Image still =
            lit_picture("AttributeBegin\nTranslate 1 2 1\n" + light + "\nAttributeEnd", still_warnings);
        const Image moving = lit_picture("AttributeBegin\n" + between("Translate 1 2 1", "Translate -3 2 1") +
                                             light + "\nAttributeEnd",
                                         moving_warnings);
        EXPECT_EQ(still_warnings, "");
        EXPECT_THAT(moving_warnings, HasSubstr("start of the motion"));
        EXPECT_THAT(moving_warnings, ::testing::ContainsRegex("^[^\n]*:[0-9]+:[0-9]+: "));
        EXPECT_EQ(still.values().size(), moving.values().size());
        EXPECT_TRUE(std::equal(still.values().begin(), still.values().end(), moving.values().begin()));
        EXPECT_GT(testing::mean_of(still, 1), 0);
    }
}

} // namespace
} // namespace alhazen
