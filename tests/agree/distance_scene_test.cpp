/// Accelerator "sdf": what the camera sees is exact, what else there is comes near it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/hash.h"
#include "formats/format.h"
#include "image/metrics.h"
#include "math/warp.h"
#include "scene/distance_scene.h"
#include "tests/support/render_scene.h"

namespace alhazen::testing {
namespace {

const char* const view = R"(
Sampler "zsobol" "integer pixelsamples" 24
Film "rgb" "integer xresolution" 48 "integer yresolution" 36
LookAt 0 1 -3.4  0 1 0  0 1 0
Camera "perspective" "float fov" 45
WorldBegin
)";

const char* const walls = R"(
AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 12 11 9 ]
Shape "trianglemesh" "point3 P" [ -.4 1.98 -.4  .4 1.98 -.4  .4 1.98 .4  -.4 1.98 .4 ]
    "integer indices" [ 0 1 2 0 2 3 ]
AttributeEnd
Material "diffuse" "rgb reflectance" [ .7 .7 .7 ]
Shape "trianglemesh" "point3 P" [ -1 0 -1  1 0 -1  1 0 1  -1 0 1  -1 2 -1  1 2 -1  1 2 1  -1 2 1 ]
    "integer indices" [ 0 1 2 0 2 3  4 6 5 4 7 6  2 6 7 2 7 3 ]
Material "diffuse" "rgb reflectance" [ .7 .1 .1 ]
Shape "trianglemesh" "point3 P" [ -1 0 -1  -1 0 1  -1 2 1  -1 2 -1 ] "integer indices" [ 0 1 2 0 2 3 ]
Material "diffuse" "rgb reflectance" [ .1 .5 .1 ]
Shape "trianglemesh" "point3 P" [ 1 0 -1  1 0 1  1 2 1  1 2 -1 ] "integer indices" [ 0 2 1 0 3 2 ]
ObjectBegin "block"
Material "diffuse" "rgb reflectance" [ .6 .6 .7 ]
Shape "trianglemesh" "point3 P" [ -1 0 -1  1 0 -1  1 0 1  -1 0 1  -1 2 -1  1 2 -1  1 2 1  -1 2 1 ]
    "integer indices" [ 0 1 2 0 2 3  4 6 5 4 7 6  2 6 7 2 7 3  0 4 5 0 5 1  1 5 6 1 6 2  0 3 7 0 7 4 ]
ObjectEnd
AttributeBegin
Translate .35 0 .2
Rotate 20 0 1 0
Scale .3 .55 .3
ObjectInstance "block"
AttributeEnd
)";

std::string scene(const std::string& integrator, const std::string& accelerator) {
    return "Integrator " + integrator + "\n" + accelerator + view + walls;
}

Image rendered(const std::string& integrator, const std::string& accelerator, int threads = 2) {
    RenderSettings settings;
    settings.threads = threads;
    return render_text(scene(integrator, accelerator), settings).image;
}

const std::string exact, field = "Accelerator \"sdf\" \"integer resolution\" 96";

TEST(DistanceScenes, WhatTheCameraSeesIsExact) {
    Image a = rendered("\"path\" \"integer maxdepth\" 0", exact);
    Image b = rendered("\"path\" \"integer maxdepth\" 0", field);
    auto va = a.values(), vb = b.values();
    EXPECT_GT(mean_of(a, 0), 0.01);
    EXPECT_EQ(std::memcmp(va.data(), vb.data(), va.size_bytes()), 0);
}

TEST(DistanceScenes, LightComesNearTheExactOne) {
    for (std::string integrator :
         {"\"path\" \"integer maxdepth\" 3", "\"ambientocclusion\" \"float maxdistance\" 1"}) {
        SCOPED_TRACE(integrator);
        Image a = rendered(integrator, exact), b = rendered(integrator, field);
        double flip = compute_metric(Metric::flip, b, a).value;
        EXPECT_LT(flip, 0.12);
        EXPECT_NEAR(mean_of(b, 1) / mean_of(a, 1), 1, 0.1);
        // And it is not the exact one by mistake.
        EXPECT_GT(flip, 0.001);
    }
}

// A closed room with a finely divided ball in it, most of whose triangles no sample is nearest to. From
// within the room every ray meets something, and mostly what it meets exactly.
TEST(DistanceScenes, FewRaysLeaveAClosedRoom) {
    constexpr int around = 160, rings = 80, cells = 48;
    std::string points, indices;
    for (int j = 0; j <= rings; ++j)
        for (int i = 0; i <= around; ++i) {
            const float a = 2 * pi * static_cast<float>(i) / around, b = pi * static_cast<float>(j) / rings;
            for (float x : {std::cos(a) * std::sin(b), std::cos(b), std::sin(a) * std::sin(b)})
                points += std::to_string(0.5f * x) + " ";
            if (i == around || j == rings) continue;
            const int k = j * (around + 1) + i;
            for (int corner : {k, k + 1, k + around + 2, k, k + around + 2, k + around + 1})
                indices += std::to_string(corner) + " ";
        }
    const std::string text = "WorldBegin\nShape \"trianglemesh\" \"point3 P\" [ " + points +
                             " ] \"integer indices\" [ " + indices +
                             R"(]
Shape "trianglemesh" "point3 P" [ -2 -1 -1  2 -1 -1  2 1 -1  -2 1 -1  -2 -1 1  2 -1 1  2 1 1  -2 1 1 ]
    "integer indices" [ 0 1 2 0 2 3  4 6 5 4 7 6  0 5 1 0 4 5  2 7 3 2 6 7  0 3 7 0 7 4  1 6 2 1 5 6 ])";
    Messages messages;
    auto world = build_world(read_pbrt_string(text, ".", messages), {}, messages);
    const DistanceScene coarse(world->scene->root(), cells);
    const float cell = 4.0f / cells;
    Rng rng(3);
    int rays = 0, lost = 0, same = 0;
    while (rays < 20000) {
        auto u = [&] { return rng.uniform() * 2 - 1; };
        const Vec3 o{1.9f * u(), 0.95f * u(), 0.95f * u()};
        if (length(o) < 0.55f) continue;
        const Ray ray{o, sample_sphere({rng.uniform(), rng.uniform()})};
        ++rays;
        const auto meets = world->scene->closest(ray), met = coarse.closest(ray);
        ASSERT_TRUE(meets);
        lost += !met;
        same += met && length(met->p - meets->p) < 1.5f * cell;
    }
    EXPECT_LT(lost, 0.006 * rays);
    EXPECT_GT(same, 0.99 * rays);
    RecordProperty("elsewhere", rays - same);
}

TEST(DistanceScenes, ThreadsDoNotChangeABit) {
    Image a = rendered("\"path\"", field, 1), b = rendered("\"path\"", field, 3);
    auto va = a.values(), vb = b.values();
    EXPECT_EQ(std::memcmp(va.data(), vb.data(), va.size_bytes()), 0);
}

// Rays to lamps go through media by another way; lamps must not block their own light there.
TEST(DistanceScenes, LampsAreSeenThroughMedia) {
    std::string text = scene("\"volpath\" \"integer maxdepth\" 2", field);
    const Image clear = render_text(text).image;
    const std::string camera = "LookAt";
    text.insert(text.find(camera), "MakeNamedMedium \"thin\" \"string type\" \"homogeneous\" "
                                   "\"rgb sigma_a\" [ 1e-6 1e-6 1e-6 ] \"rgb sigma_s\" [ 1e-6 1e-6 1e-6 ]\n"
                                   "MediumInterface \"\" \"thin\"\n");
    const Image thin = render_text(text).image;
    EXPECT_GT(mean_of(clear, 1), 0.05);
    EXPECT_NEAR(mean_of(thin, 1) / mean_of(clear, 1), 1, 0.01);
}

// Marched in company or alone.
TEST(DistanceScenes, PathsInFlightDoNotChangeABit) {
    RenderSettings alone, many;
    alone.paths_in_flight = 1;
    many.paths_in_flight = 100;
    const std::string text = scene("\"path\"", field);
    Image a = render_text(text, alone).image, b = render_text(text, many).image;
    auto va = a.values(), vb = b.values();
    EXPECT_EQ(std::memcmp(va.data(), vb.data(), va.size_bytes()), 0);
}

TEST(DistanceScenes, OtherShapesAreAnError) {
    std::string text = scene("\"path\"", field) + "Shape \"sphere\" \"float radius\" .2\n";
    try {
        render_text(text);
        FAIL();
    } catch (const SceneError& e) {
        EXPECT_THAT(e.what(), ::testing::HasSubstr("knows triangles only"));
    }
}

} // namespace
} // namespace alhazen::testing
