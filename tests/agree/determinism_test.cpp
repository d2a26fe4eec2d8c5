/// The same scene, settings and seed give the same bits: on 1, 2 and 3 threads, with other tile sizes,
/// cropped, and stopped after some passes.
#include <gtest/gtest.h>

#include "tests/support/render_scene.h"

namespace alhazen::testing {
namespace {

const char* const scene = R"(
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
    return render_text(scene, settings).image;
}

TEST(Determinism, ThreadsAndTilesDoNotChangeABit) {
    Image reference = rendered(1, 16);
    EXPECT_GT(mean_of(reference, 0), 0.05);
    for (int threads : {1, 2, 3})
        for (int tile : {7, 16}) expect_same_bits(rendered(threads, tile), reference);
    expect_same_bits(render_text(scene, {}).image, reference);
}

TEST(Determinism, RaysInCompanyDoNotChangeABit) {
    Image reference = rendered(1, 16, 1);
    for (int paths : {2, 3, 64, 128, 500}) expect_same_bits(rendered(2, 16, paths), reference);
    // More paths than samples that may end before the slowest: some wait.
    expect_same_bits(rendered(1, 64, 4096), reference);
}

TEST(Determinism, EveryIntegratorIsTheSameOnEverySchedule) {
    for (const Kind<Integrator>& kind : integrator_kinds().all()) {
        RenderSettings settings;
        settings.integrator = kind.name;
        settings.paths_in_flight = 1;
        Image alone = render_text(scene, settings).image;
        settings.paths_in_flight = 100;
        expect_same_bits(render_text(scene, settings).image, alone);
    }
}

TEST(Determinism, ACropShowsTheSamePixels) {
    Image whole = rendered(2, 16);
    RenderSettings settings;
    settings.crop = Rect2i{{10, 5}, {31, 20}};
    Image part = render_text(scene, settings).image;
    Image expected = whole.crop({{10, 5}, {31, 20}});
    expect_same_bits(part, expected);
}

TEST(Determinism, AnotherSeedIsAnotherImage) {
    RenderSettings settings;
    settings.seed = 7;
    Image other = render_text(scene, settings).image;
    Image reference = rendered(1, 16);
    EXPECT_NE(std::memcmp(other.values().data(), reference.values().data(), other.values().size_bytes()), 0);
}

TEST(Determinism, CancellingFinishesThePassInHand) {
    Messages messages;
    auto world = build_world(read_pbrt_string(scene, ".", messages), {}, messages);
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
    RenderStats stats = render_text(scene, settings).stats;
    EXPECT_EQ(stats.rays.camera, 53u * 37u * 8u);
    EXPECT_GT(stats.rays.bounce, stats.rays.camera / 4);
    EXPECT_GT(stats.rays.shadow, stats.rays.camera / 4);
    EXPECT_EQ(stats.bad_samples, 0u);
}

} // namespace
} // namespace alhazen::testing
