/// The rasteriser's pictures: against Whitted's local light, which is computed without it, against its own by
/// rays, and against themselves on other threads, kernels and crops.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "raster/dispatch.h"
#include "raster/rasterizer.h"
#include "tests/support/render_scene.h"

namespace alhazen::testing {
namespace {

const std::string header = R"(
Film "rgb" "integer xresolution" 120 "integer yresolution" 90
LookAt 0 2 -6  0 .5 0  0 1 0
Camera "perspective" "float fov" 50
WorldBegin
)";

const std::string things = R"(
Texture "checks" "spectrum" "checkerboard" "float uscale" 8 "float vscale" 8
    "rgb tex1" [ .1 .1 .1 ] "rgb tex2" [ .8 .8 .7 ]
Material "diffuse" "texture reflectance" "checks"
Shape "trianglemesh" "point3 P" [ -5 -1 -5  5 -1 -5  5 -1 5  -5 -1 5 ] "integer indices" [ 0 1 2  0 2 3 ]
    "point2 uv" [ 0 0  1 0  1 1  0 1 ]
Material "phong" "rgb diffuse" [ .6 .2 .2 ] "rgb specular" [ .5 .5 .5 ] "float shininess" 30
Shape "sphere" "float radius" 1
Material "diffuse" "rgb reflectance" [ .3 .5 .7 ]
ObjectBegin "tent"
Shape "trianglemesh" "point3 P" [ -1 -1 0  1 -1 0  0 1 .5 ] "normal N" [ -.5 0 -1  .5 0 -1  0 .5 -1 ]
ObjectEnd
AttributeBegin
Translate 2 0 1
ObjectInstance "tent"
AttributeEnd
Translate -2 0 1
Rotate 20 1 0 0
Shape "cylinder" "float radius" .6
)";

const std::string point_lights = R"(
LightSource "point" "point3 from" [ 3 5 -4 ] "rgb I" [ 20 18 15 ]
LightSource "distant" "point3 from" [ -1 2 -1 ] "rgb L" [ .3 .3 .5 ]
LightSource "spot" "point3 from" [ -3 4 -3 ] "point3 to" [ 0 0 0 ] "rgb I" [ 10 20 10 ] "float coneangle" 25
)";

Image rendered(const std::string& text, const std::string& integrator,
               const std::vector<std::string>& overrides, int spp = 1, int threads = 2) {
    RenderSettings settings;
    settings.integrator = integrator;
    settings.overrides = overrides;
    settings.spp = spp;
    settings.threads = threads;
    settings.color = ColorMode::rgb;
    return render_text(text, settings).image;
}

// Pixels whose channels differ by more than a fraction of one (of what is larger than one).
double share_that_differs(const Image& a, const Image& b, float tolerance) {
    int differ = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) {
            bool same = true;
            for (int c = 0; c < 3; ++c) {
                const float u = a.rgb(x, y)[c], v = b.rgb(x, y)[c];
                same &= std::abs(u - v) <= tolerance * std::max(1.0f, std::max(u, v));
            }
            differ += !same;
        }
    return static_cast<double>(differ) / (static_cast<double>(a.width()) * a.height());
}

bool same_bits(const Image& a, const Image& b) {
    return a.values().size() == b.values().size() &&
           std::memcmp(a.values().data(), b.values().data(), a.values().size_bytes()) == 0;
}

TEST(RasterPicture, IsWhittedsLocalLight) {
    const std::string text = header + point_lights + things;
    const Image raster = rendered(text, "raster", {});
    const Image whitted = rendered(text, "whitted", {"integrator.maxdepth=1", "integrator.shadows=false"});
    EXPECT_GT(mean_of(raster, 0), 0.05);
    // But for pixels whose middle is on an edge.
    EXPECT_LE(share_that_differs(raster, whitted, 1e-3f), 0.001);
}

TEST(RasterPicture, IsTheSameByRays) {
    const std::string lights = R"(
LightSource "infinite" "rgb L" [ .2 .3 .5 ]
AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 9 9 9 ]
Translate 0 4 0
Shape "sphere" "float radius" .3
Shape "trianglemesh" "point3 P" [ -3 0 -3  -2 0 -3  -2 0 -2  -3 0 -2 ] "integer indices" [ 0 1 2  0 2 3 ]
AttributeEnd
)";
    for (const char* shadows : {"false", "true"}) {
        const std::string text = header + point_lights + lights + things;
        const std::string choice = std::string("integrator.shadows=") + shadows;
        // A lens so small that it blurs nothing; a camera with a lens has no projection.
        const Image raster = rendered(text, "raster", {choice});
        const Image rays = rendered(text, "raster", {choice, "camera.lensradius=1e-9"});
        EXPECT_LE(share_that_differs(raster, rays, 2e-3f), 0.002) << shadows;
    }
}

// Rays see one of the materials at each point; here all count, each with its own relief.
TEST(RasterPicture, OfAMixtureIsTheMixtureOfItsPartsPictures) {
    auto picture = [](const std::string& shown) {
        return rendered(header + point_lights + R"(
LightSource "infinite" "rgb L" [ .2 .3 .5 ]
Texture "bumps" "float" "windy"
Texture "stripes" "float" "checkerboard" "float uscale" 4 "float vscale" .01 "float tex1" .2 "float tex2" 1
MakeNamedMaterial "clay" "string type" "diffuse" "rgb reflectance" [ .7 .3 .2 ] "texture displacement" "bumps"
MakeNamedMaterial "shine" "string type" "phong" "rgb specular" [ .5 .5 .5 ] "float shininess" 20
MakeNamedMaterial "paint" "string type" "diffuse" "rgb reflectance" [ .2 .3 .8 ]
MakeNamedMaterial "nothing" "string type" "interface"
MakeNamedMaterial "striped paint" "string type" "mix" "string materials" [ "clay" "paint" ]
    "texture amount" "stripes"
)" + shown + R"(
Shape "trianglemesh" "point3 P" [ -5 -1 -5  5 -1 -5  5 -1 5  -5 -1 5 ] "integer indices" [ 0 1 2  0 2 3 ]
Shape "sphere" "float radius" 1
ObjectBegin "tent"
Shape "trianglemesh" "point3 P" [ -1 -1 0  1 -1 0  0 1 .5 ] "normal N" [ -.5 0 -1  .5 0 -1  0 .5 -1 ]
ObjectEnd
Translate 2 0 1
ObjectInstance "tent"
)",
                        "raster", {});
    };
    auto one = [](const std::string& name) { return "NamedMaterial \"" + name + "\"\n"; };
    auto mixed = [](const std::string& a, const std::string& b, const std::string& amount) {
        return "Material \"mix\" \"string materials\" [ \"" + a + "\" \"" + b + "\" ] \"float amount\" " +
               amount + "\n";
    };
    for (auto [a, b] : {std::pair{"clay", "shine"}, std::pair{"shine", "paint"}, std::pair{"paint", "clay"},
                        std::pair{"striped paint", "shine"}}) {
        Image first = picture(one(a)), second = picture(one(b));
        const Image mixture = picture(mixed(a, b, ".3"));
        double largest = 0;
        for (int y = 0; y < mixture.height(); ++y)
            for (int x = 0; x < mixture.width(); ++x)
                for (int c = 0; c < 3; ++c)
                    largest = std::max(largest, std::abs(.7 * first.rgb(x, y)[c] + .3 * second.rgb(x, y)[c] -
                                                         mixture.rgb(x, y)[c]));
        EXPECT_LT(largest, 1e-5) << a << " and " << b;
        EXPECT_GT(share_that_differs(first, mixture, 1e-2f), .2) << a << " and " << b;
    }
    // What is behind shows through as it does through glass: never black, as if nothing were there.
    const Image half = picture(mixed("paint", "nothing", ".999"));
    for (int x : {20, 60, 100}) EXPECT_GT(half.rgb(x, 86)[2], 0.05f);
}

TEST(RasterPicture, BlinnsHighlightIsAsWideAsPhongs) {
    const std::string text = header + point_lights + things;
    const Image phong = rendered(text, "raster", {}),
                blinn = rendered(text, "raster", {"integrator.highlight=blinn"});
    EXPECT_FALSE(same_bits(phong, blinn));
    EXPECT_NEAR(mean_of(blinn, 1) / mean_of(phong, 1), 1, 0.02);
}

TEST(RasterPicture, HasTheSameBitsOnAnyThreadsKernelAndCrop) {
    const std::string text = header + point_lights + things;
    for (int spp : {1, 4}) {
        const Image reference = rendered(text, "raster", {}, spp, 1);
        for (int threads : {2, 3})
            EXPECT_TRUE(same_bits(rendered(text, "raster", {}, spp, threads), reference));
        RenderSettings settings;
        settings.integrator = "raster";
        settings.spp = spp;
        settings.crop = Rect2i{{37, 11}, {95, 80}};
        const Image part = render_text(text, settings).image;
        EXPECT_TRUE(same_bits(part, reference.crop(*settings.crop)));
    }
    Messages messages;
    RenderSettings settings;
    settings.integrator = "raster";
    auto world = build_world(read_pbrt_string(text, ".", messages), settings, messages);
    std::vector<std::vector<std::uint32_t>> numbers;
    for (const RasterKernel* kernel : supported_raster_kernels()) {
        Rasterizer rasterizer(*world->scene, *world->camera, 8);
        rasterizer.set_kernel(*kernel);
        const Rect2i pixels = world->film->pixels();
        auto& all = numbers.emplace_back(static_cast<std::size_t>(pixels.width()) *
                                         static_cast<std::size_t>(pixels.height()) * 16);
        rasterizer.run(pixels, [&](const DrawnTile& tile) {
            for (int y = tile.pixels().lo.y; y < tile.pixels().hi.y; ++y)
                for (int x = tile.pixels().lo.x; x < tile.pixels().hi.x; ++x)
                    for (std::uint32_t s = 0; s < 8; ++s) {
                        const std::size_t at = (static_cast<std::size_t>(y * pixels.width() + x) * 8 + s) * 2;
                        all[at] = tile.number({x, y}, s);
                        all[at + 1] = std::bit_cast<std::uint32_t>(tile.nearness({x, y}, s));
                    }
        });
    }
    for (const auto& other : numbers) EXPECT_EQ(other, numbers.front());
}

// A glowing quad that covers 31.4 % of the picture, at a slant: the mean is what the samples say of its area.
TEST(RasterPicture, SamplesMeasureArea) {
    const std::string text = R"(
Film "rgb" "integer xresolution" 64 "integer yresolution" 64
Camera "orthographic"
WorldBegin
AreaLightSource "diffuse" "rgb L" [ 1 1 1 ] "bool twosided" true
Material "diffuse" "float reflectance" 0
Rotate 17 0 0 1
Scale .62 .5065 1
Translate 0 0 1
Shape "trianglemesh" "point3 P" [ -1 -1 0  1 -1 0  1 1 0  -1 1 0 ] "integer indices" [ 0 1 2  0 2 3 ]
)";
    for (auto [samples, tolerance] :
         {std::pair{1, 4e-3}, std::pair{4, 1.5e-3}, std::pair{8, 1e-3}, std::pair{16, 6e-4}})
        EXPECT_NEAR(mean_of(rendered(text, "raster", {}, samples), 0), .62 * .5065, tolerance) << samples;
}

TEST(RasterPicture, ShadowMapsShadeWhatRaysSayIsShaded) {
    const std::string text = header + point_lights + things;
    const Image maps =
        rendered(text, "raster", {"integrator.shadows=true", "integrator.shadowresolution=2048"});
    const Image rays = rendered(text, "whitted", {"integrator.maxdepth=1"});
    const Image open = rendered(text, "raster", {});
    // The maps' edges are soft and rough: what is left is a rim around each shadow.
    const double without = share_that_differs(open, rays, 0.02f),
                 with = share_that_differs(maps, rays, 0.02f);
    EXPECT_GE(without, 0.05);
    EXPECT_LE(with, without / 4);
}

TEST(RasterPicture, ACameraThatSeesAllAroundIsServedByRays) {
    std::string text = header + point_lights + things;
    text.replace(text.find("\"perspective\" \"float fov\" 50"), 28, "\"spherical\"");
    RenderSettings settings;
    settings.integrator = "raster";
    const Rendered picture = render_text(text, settings);
    EXPECT_GT(mean_of(picture.image, 0), 0.01);
    EXPECT_EQ(picture.stats.rays.camera, 120u * 90u * 4u);
}

TEST(RasterPicture, SamplesAreRoundedUpToAPattern) {
    const std::string text = header + things;
    for (auto [asked, given] :
         {std::pair{1, 1}, std::pair{2, 4}, std::pair{5, 8}, std::pair{9, 16}, std::pair{400, 16}}) {
        RenderSettings settings;
        settings.integrator = "raster";
        settings.spp = asked;
        EXPECT_EQ(render_text(text, settings).stats.samples, given);
    }
}

TEST(RasterPicture, OtherPatternsAreErrors) {
    try {
        render_text("Integrator \"raster\" \"integer samples\" 3\nWorldBegin\nShape \"sphere\"\n");
        FAIL();
    } catch (const std::exception& e) {
        EXPECT_THAT(e.what(), ::testing::HasSubstr("must be 1, 4, 8 or 16"));
    }
}

} // namespace
} // namespace alhazen::testing
