/// The same scene, settings and seed give the same bits: on 1, 2 and 3 threads, with other tile sizes,
/// cropped, and stopped after some passes.
#include <gtest/gtest.h>

#include "tests/support/render_scene.h"

namespace alhazen::testing {
namespace {

const char* const everything = R"(
Integrator "path" "integer maxdepth" 5
Sampler "zsobol" "integer pixelsamples" 8
Film "rgb" "integer xresolution" 53 "integer yresolution" 37
LookAt 0 1 -4  0 1 0  0 1 0
Camera "perspective" "float fov" 45 "float lensradius" .05 "float focaldistance" 4
WorldBegin
LightSource "infinite" "rgb L" [ .3 .4 .6 ]
AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 8 6 4 ]
Translate 1 2.5 -1
Shape "sphere" "float radius" .2
AttributeEnd
Texture "checks" "spectrum" "checkerboard" "float uscale" 20 "float vscale" 20
    "rgb tex1" [ .1 .1 .1 ] "rgb tex2" [ .8 .8 .7 ]
Material "diffuse" "texture reflectance" "checks"
Shape "bilinearmesh" "point3 P" [ -5 0 -5  5 0 -5  -5 0 5  5 0 5 ]
Material "dielectric" "spectrum eta" "glass-SF11"
Translate -.8 .7 0
Shape "sphere" "float radius" .7
Material "conductor" "float roughness" .1
Translate 1.6 0 0
Shape "sphere" "float radius" .7
)";

void expect_same_bits(const Image& a, const Image& b) {
    ASSERT_EQ(a.size(), b.size());
    auto va = a.values(), vb = b.values();
    ASSERT_EQ(va.size(), vb.size());
    EXPECT_EQ(std::memcmp(va.data(), vb.data(), va.size_bytes()), 0);
}

Image rendered(int threads, int tile_size, int paths_in_flight = 100) {
    RenderSettings settings;
    settings.threads = threads;
    settings.tile_size = tile_size;
    settings.paths_in_flight = paths_in_flight;
    return render_text(everything, settings).image;
}

TEST(Determinism, ThreadsAndTilesDoNotChangeABit) {
    Image reference = rendered(1, 16);
    EXPECT_GT(mean_of(reference, 0), 0.05);
    for (int threads : {1, 2, 3})
        for (int tile : {7, 16}) expect_same_bits(rendered(threads, tile), reference);
    expect_same_bits(render_text(everything, {}).image, reference);
}

TEST(Determinism, RaysInCompanyDoNotChangeABit) {
    Image reference = rendered(1, 16, 1);
    for (int paths : {2, 3, 64, 128, 500}) expect_same_bits(rendered(2, 16, paths), reference);
    // More paths than samples that may end before the slowest: some wait.
    expect_same_bits(rendered(1, 64, 4096), reference);
}

TEST(Determinism, EveryIntegratorIsTheSameOnEverySchedule) {
    for (const Kind<Integrator>& kind : integrator_kinds().all()) {
        SCOPED_TRACE(kind.name);
        RenderSettings settings;
        settings.integrator = kind.name;
        if (kind.name == "mlt") settings.overrides = {"integrator.bootstrapsamples=2000"};
        settings.paths_in_flight = 1;
        settings.threads = 1;
        Image alone = render_text(everything, settings).image;
        settings.paths_in_flight = 100;
        expect_same_bits(render_text(everything, settings).image, alone);
        settings.threads = 3;
        expect_same_bits(render_text(everything, settings).image, alone);
    }
}

// Few whole spheres are tested apart from the structure, unless somebody chooses one.
const char* const balls_and_others = R"(
Integrator "path" "integer maxdepth" 6
Sampler "independent" "integer pixelsamples" 4
Film "rgb" "integer xresolution" 61 "integer yresolution" 41
LookAt 0 2 -6  0 .8 0  0 1 0
Camera "perspective" "float fov" 45
WorldBegin
LightSource "infinite" "rgb L" [ .3 .4 .6 ]
LightSource "point" "point3 from" [ 2 6 -3 ] "rgb I" [ 30 30 30 ]
Material "diffuse" "rgb reflectance" [ .5 .4 .3 ]
Shape "bilinearmesh" "point3 P" [ -5 0 -5  5 0 -5  -5 0 5  5 0 5 ]
Shape "trianglemesh" "point3 P" [ -1 0 1  1 0 1  0 2 1 ]
ObjectBegin "pair"
    Shape "sphere" "float radius" .4
    Translate 0 .7 0
    Material "dielectric"
    Shape "sphere" "float radius" .3
    Shape "sphere" "float radius" .3
ObjectEnd
AttributeBegin
    Translate 1.5 .4 -1
    ObjectInstance "pair"
    Translate .8 0 .3
    Scale 1 1.5 1
    ObjectInstance "pair"
AttributeEnd
Translate -1.2 .7 -.5
Shape "sphere" "float radius" .7 "float alpha" .5
Shape "sphere" "float radius" .6
Material "interface"
Shape "sphere" "float radius" .9
Material "diffuse"
AreaLightSource "diffuse" "rgb L" [ 8 6 4 ]
Translate 1 2 0
Shape "sphere" "float radius" .2
)";

TEST(Determinism, BallsApartFromTheStructureDoNotChangeABit) {
    for (int paths : {1, 64}) {
        RenderSettings settings;
        settings.paths_in_flight = paths;
        Image apart = render_text(balls_and_others, settings).image;
        EXPECT_GT(mean_of(apart, 0), 0.05);
        std::string error;
        settings.accel = parse_accel("sah/stack", error);
        ASSERT_TRUE(settings.accel) << error;
        expect_same_bits(render_text(balls_and_others, settings).image, apart);
    }
}

TEST(Determinism, ACropShowsTheSamePixels) {
    Image whole = rendered(2, 16);
    RenderSettings settings;
    settings.crop = Rect2i{{10, 5}, {31, 20}};
    Image part = render_text(everything, settings).image;
    Image expected = whole.crop({{10, 5}, {31, 20}});
    expect_same_bits(part, expected);
}

TEST(Determinism, AnotherSeedIsAnotherImage) {
    RenderSettings settings;
    settings.seed = 7;
    Image other = render_text(everything, settings).image;
    Image reference = rendered(1, 16);
    EXPECT_NE(std::memcmp(other.values().data(), reference.values().data(), other.values().size_bytes()), 0);
}

TEST(Determinism, CancellingFinishesThePassInHand) {
    Messages messages;
    auto world = build_world(read_pbrt_string(everything, ".", messages), {}, messages);
    std::atomic<bool> cancel{true};
    RenderWatch watch;
    watch.cancel = &cancel;
    RenderStats stats = render(*world, {}, watch);
    EXPECT_TRUE(stats.cancelled);
    EXPECT_EQ(stats.samples, 1);
    RenderSettings one;
    one.spp = 1;
    // One sample of an 8-sample sequence is not the 1-sample picture, but every pixel has it.
    EXPECT_EQ(stats.rays.camera, 53u * 37u);
    EXPECT_GT(mean_of(world->film->image(), 1), 0.01);
}

TEST(Determinism, RaysAreCountedByKind) {
    RenderSettings settings;
    settings.threads = 2;
    RenderStats stats = render_text(everything, settings).stats;
    EXPECT_EQ(stats.rays.camera, 53u * 37u * 8u);
    EXPECT_GT(stats.rays.bounce, stats.rays.camera / 4);
    EXPECT_GT(stats.rays.shadow, stats.rays.camera / 5);
    EXPECT_EQ(stats.bad_samples, 0u);
}

} // namespace
} // namespace alhazen::testing
