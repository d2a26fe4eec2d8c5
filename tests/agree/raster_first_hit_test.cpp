/// What the rasteriser shows in a pixel is what a ray through it meets first: in scenes made to be difficult,
/// and in the shared scenes, which lie beside the checkout (the tests skip and say so where they do not).
#include <gtest/gtest.h>

#include "base/hash.h"
#include "formats/format.h"
#include "tests/support/first_hit.h"

namespace alhazen::testing {
namespace {

std::unique_ptr<World> load(SceneDescription description, Messages& messages) {
    RenderSettings settings;
    settings.integrator = "raster";
    return build_world(std::move(description), settings, messages);
}

Agreement compare_text(const std::string& text) {
    Messages messages;
    auto world = load(read_pbrt_string(text, ".", messages), messages);
    return compare_first_hits(*world);
}

void expect_agreement(const std::string& text, std::size_t hits = 5000) {
    const Agreement agreement = compare_text(text);
    EXPECT_GE(agreement.share(), 0.9995) << agreement.same << " of " << agreement.pixels;
    EXPECT_GE(agreement.hits, hits);
}

const std::string film = R"(Film "rgb" "integer xresolution" 160 "integer yresolution" 117
)";

// A hundred triangles of every size through each other, some behind the eye and some through its plane.
std::string triangle_soup() {
    std::string points;
    Rng rng(8);
    auto number = [&](float scale) { points += std::to_string((rng.uniform() * 2 - 1) * scale) + " "; };
    for (int i = 0; i < 300; ++i) {
        const float scale = i < 30 ? 30 : 2;
        for (int axis = 0; axis < 3; ++axis) number(scale);
    }
    std::string indices;
    for (int i = 0; i < 300; ++i) indices += std::to_string(i) + " ";
    return "Shape \"trianglemesh\" \"point3 P\" [" + points + "] \"integer indices\" [" + indices + "]\n";
}

TEST(RasterFirstHit, TrianglesThroughEachOtherAndTheEyesPlane) {
    for (const char* camera :
         {"Camera \"perspective\" \"float fov\" 70\n", "Camera \"perspective\" \"float fov\" 150\n",
          "Camera \"orthographic\" \"float screenwindow\" [ -2 2 -2 2 ]\n"})
        expect_agreement(film + "LookAt .3 .2 -1  0 0 1  0 1 0\n" + camera + "WorldBegin\n" +
                         triangle_soup());
}

TEST(RasterFirstHit, AFloorThatGoesOnBehindTheEye) {
    expect_agreement(film + R"(LookAt 0 .01 0  0 0 1  0 1 0
Camera "perspective" "float fov" 90
WorldBegin
Shape "trianglemesh" "point3 P" [ -1e5 0 -1e5  1e5 0 -1e5  1e5 0 1e5  -1e5 0 1e5 ] "integer indices" [ 0 1 2  0 2 3 ]
Shape "trianglemesh" "point3 P" [ -1 -1 1e-3  1 -1 1e-3  0 .0101 1e-3 ])");
}

TEST(RasterFirstHit, ShapesThatAreNoTriangles) {
    expect_agreement(film + R"(LookAt 0 2 -6  0 0 0  0 1 0
Camera "perspective" "float fov" 60
WorldBegin
Shape "bilinearmesh" "point3 P" [ -9 -1 -9  9 -1 -9  -9 -1.5 9  9 0 9 ]
Shape "sphere" "float radius" 1 "float zmax" .6
AttributeBegin
Translate 2 0 0
Rotate 60 1 1 0
Scale .5 1 2
Shape "sphere" "float radius" .7
Shape "cylinder" "float radius" .4 "float phimax" 250
AttributeEnd
Translate -2 .5 1
Shape "disk" "float innerradius" .3
Shape "sphere" "float radius" 50)");
}

TEST(RasterFirstHit, CutoutsAreWhereTheRayTracerHasThem) {
    expect_agreement(film + R"(LookAt 0 1 -4  0 0 0  0 1 0
Camera "perspective" "float fov" 60
WorldBegin
Texture "holes" "float" "checkerboard" "float uscale" 9 "float vscale" 9 "float tex1" 0 "float tex2" 1
Texture "dust" "float" "checkerboard" "float uscale" 3 "float vscale" 3 "float tex1" .3 "float tex2" .9
Shape "trianglemesh" "texture alpha" "holes" "point3 P" [ -2 -2 0  2 -2 0  2 2 0  -2 2 0 ]
    "integer indices" [ 0 1 2  0 2 3 ] "point2 uv" [ 0 0  1 0  1 1  0 1 ]
Shape "trianglemesh" "texture alpha" "dust" "point3 P" [ -2 -2 1  2 -2 1  2 2 1.5  -2 2 1 ]
    "integer indices" [ 0 1 2  0 2 3 ] "point2 uv" [ 0 0  1 0  1 1  0 1 ]
Translate 0 0 -1
Shape "sphere" "float radius" .8 "texture alpha" "holes")");
}

// Instances in instances: near ones are drawn, far ones, of which a pixel holds many triangles, are cast.
TEST(RasterFirstHit, InstancesNearAndFar) {
    std::string mesh;
    constexpr int side = 40;
    std::string points, indices;
    for (int j = 0; j <= side; ++j)
        for (int i = 0; i <= side; ++i) {
            const float x = static_cast<float>(i) / side, y = static_cast<float>(j) / side;
            points += std::to_string(x) + " " + std::to_string(y) + " " +
                      std::to_string(.2f * std::sin(9 * x) * y) + " ";
            if (i == side || j == side) continue;
            const int a = j * (side + 1) + i;
            for (int corner : {a, a + 1, a + side + 2, a, a + side + 2, a + side + 1})
                indices += std::to_string(corner) + " ";
        }
    std::string text = film + R"(LookAt 0 1 -3  0 0 2  0 1 0
Camera "perspective" "float fov" 60
WorldBegin
Material "interface"
Shape "sphere" "float radius" 1.5
Material "diffuse"
ObjectBegin "leaf"
Shape "trianglemesh" "point3 P" [)" +
                       points + "] \"integer indices\" [" + indices + R"(]
ObjectEnd
ObjectBegin "two"
ObjectInstance "leaf"
Translate -1.2 0 .3
Rotate 30 0 1 0
ObjectInstance "leaf"
ObjectEnd
)";
    for (int i = 0; i < 40; ++i)
        text += "AttributeBegin\nTranslate " + std::to_string(i % 7 - 3) + " " + std::to_string(i % 3 - 1) +
                " " + std::to_string(i * i * .3) + "\nObjectInstance \"two\"\nAttributeEnd\n";
    expect_agreement(text, 3500);
}

class SharedScene : public ::testing::TestWithParam<const char*> {};

TEST_P(SharedScene, ShowsWhatRaysMeetFirst) {
    auto file =
        std::filesystem::path(ALHAZEN_SOURCE_DIR) / "../shared/scenes/pbrt" / GetParam() / "scene.pbrt";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
    Messages messages;
    messages.lenient = true;
    auto world = load(read_scene(file, messages), messages);
    const Agreement agreement = compare_first_hits(*world);
    EXPECT_GE(agreement.share(), 0.999) << agreement.same << " of " << agreement.pixels;
    RecordProperty("differ", static_cast<int>(agreement.pixels - agreement.same));
}

INSTANTIATE_TEST_SUITE_P(Pbrt, SharedScene,
                         ::testing::Values("coffee", "cornell-box", "kitchen", "living-room-2",
                                           "material-testball", "menger", "staircase", "teapot-cloud",
                                           "veach-ajar", "veach-bidir"),
                         [](const auto& scene) {
                             std::string name = scene.param;
                             std::erase(name, '-');
                             return name;
                         });

} // namespace
} // namespace alhazen::testing
