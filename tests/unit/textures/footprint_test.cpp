/// What a pixel covers of a texture, and blends.
#include "base/hash.h"
#include "image/pyramid.h"
#include "tests/unit/textures/support.h"
#include "textures/mapping.h"
#include "textures/noise.h"

namespace alhazen {

namespace {

/// A camera above the origin that looks down on the plane z = 0, whose u and v are x / 2 and y.
struct Looking {
    PixelCone cone;
    Hit hit;

    Looking(Vec3 from, float spread, Vec3 p = {}) {
        cone.origin = from;
        cone.spread = spread;
        hit.p = p;
        hit.ng = hit.ns = {0, 0, 1};
        hit.dpdu = {2, 0, 0};
        hit.dpdv = {0, 1, 0};
        hit.uv = {p.x / 2, p.y};
        hit.cone = &cone;
    }
    Looking(const Looking&) = delete;
    TexturePoint point() const { return TexturePoint(hit); }
};

TEST(PixelCone, IsARoundSpotHeadOn) {
    const PixelCone cone{{0, 0, 5}, {}, 0.1f, 0.02f};
    const auto e = cone.on_surface({}, {0, 0, 1});
    EXPECT_NEAR(length(e.narrow), 0.2f, 1e-6f);
    EXPECT_NEAR(length(e.wide), 0.2f, 1e-6f);
    EXPECT_NEAR(dot(e.narrow, e.wide), 0, 1e-7f);
    EXPECT_NEAR(e.narrow.z, 0, 1e-7f);
}

TEST(PixelCone, IsLongAlongTheViewWhereItGrazes) {
    // 60 degrees off the normal, in x and z.
    const PixelCone cone{{std::sqrt(3.0f), 0, 1}, {}, 0, 0.01f};
    const auto e = cone.on_surface({}, {0, 0, 1});
    EXPECT_NEAR(length(e.narrow), 0.02f, 1e-5f);
    EXPECT_NEAR(std::abs(e.narrow.y), 0.02f, 1e-5f);
    EXPECT_NEAR(std::abs(e.wide.x), 0.04f, 1e-5f);
    PixelCone parallel;
    parallel.parallel = normalize(Vec3(-std::sqrt(3.0f), 0, -1));
    parallel.width = 0.02f;
    EXPECT_NEAR(std::abs(parallel.on_surface({100, 2, 0}, {0, 0, 1}).wide.x), 0.04f, 1e-5f);
}

float largest_step(const TextureFootprint& f) {
    return std::max({std::abs(f.a.x), std::abs(f.a.y), std::abs(f.b.x), std::abs(f.b.y)});
}

TEST(Footprint, OfSurfaceParameters) {
    const Looking at({0, 0, 10}, 0.01f);
    TextureMapping map;
    map.uscale = 3;
    const TextureFootprint f = map.footprint(at.point());
    // 0.1 wide: 0.05 of u, times 3, and 0.1 of v.
    EXPECT_NEAR(std::max(std::abs(f.a.x), std::abs(f.b.x)), 0.15f, 1e-5f);
    EXPECT_NEAR(std::max(std::abs(f.a.y), std::abs(f.b.y)), 0.1f, 1e-5f);
    EXPECT_EQ(largest_step(map.footprint(at_uv(0.5f, 0.5f))), 0);
}

TEST(Footprint, OfProjections) {
    TextureMapping map;
    map.mapping = MappingKind::planar;
    map.v1 = {4, 0, 0};
    const Looking below({0, 0, 10}, 0.01f);
    EXPECT_NEAR(largest_step(map.footprint(below.point())), 0.4f, 1e-5f);
    // Where the angle leaps from 1 to 0 the step is as small as elsewhere.
    map.mapping = MappingKind::spherical;
    const Looking seam({5, 0, 10}, 0.01f, {5, 0, 0}), elsewhere({0, 5, 10}, 0.01f, {0, 5, 0});
    EXPECT_NEAR(largest_step(map.footprint(seam.point())), largest_step(map.footprint(elsewhere.point())),
                2e-3f);
    map.mapping = MappingKind::cylindrical;
    const Looking other_seam({-5, 0, 10}, 0.01f, {-5, 0, 0});
    EXPECT_NEAR(largest_step(map.footprint(other_seam.point())), 0.1f / (2 * pi * 5), 1e-3f);
}

TEST(Footprint, DoesWithoutTangents) {
    Looking at({0, 0, 10}, 0.01f);
    at.hit.dpdu = at.hit.dpdv = {};
    EXPECT_EQ(largest_step(TextureMapping().footprint(at.point())), 0);
    at.cone.origin = {};
    EXPECT_EQ(largest_step(TextureMapping().footprint(at.point())), 0);
}

// Columns that are black and white by turns.
Image stripes(int size) {
    Image image = Image::grey_image(size, size);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) image.at(x, y) = x % 2 ? 1.0f : 0.0f;
    return image;
}

TEST(Ewa, BlursAcrossButNotAlong) {
    const auto texels = channel_pyramid(stripes(64), 0, WrapMode::repeat);
    auto value = [](float v) { return v; };
    const Vec2 on_white{(31 + 0.5f) / 64, 0.5f};
    const float texel = 1.0f / 64;
    // Eight texels along the stripe and hardly any across, or the other way.
    EXPECT_GT(texels.ewa(on_white, {0, 8 * texel}, {texel, 0}, 16, value), 0.65f);
    EXPECT_NEAR(texels.ewa(on_white, {8 * texel, 0}, {0, texel}, 16, value), 0.5f, 0.05f);
    // Thinner than it may be: as if it were wider.
    EXPECT_NEAR(texels.ewa(on_white, {0, 64 * texel}, {texel, 0}, 4, value), 0.5f, 0.05f);
    // A point is what bilinear says; so is what is not finite.
    EXPECT_EQ(texels.ewa(on_white, {}, {}, 8, value), texels.bilinear(0, on_white));
    EXPECT_EQ(texels.ewa(on_white, {infinity, 0}, {1, 0}, 8, value), texels.bilinear(0, on_white));
    EXPECT_NEAR(texels.ewa(on_white, {100, 0}, {0, 100}, 8, value), 0.5f, 1e-6f);
}

TEST(Ewa, IsTheGaussianOverTheEllipse) {
    // Of a linear ramp it is the middle, of a constant the constant.
    Image ramp = Image::grey_image(64, 64);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) ramp.at(x, y) = static_cast<float>(x + 2 * y);
    const auto texels = channel_pyramid(ramp, 0, WrapMode::clamp);
    auto value = [](float v) { return v; };
    Rng rng(1);
    for (int i = 0; i < 200; ++i) {
        const Vec2 uv{0.4f + 0.2f * rng.uniform(), 0.4f + 0.2f * rng.uniform()};
        auto part = [&] { return 0.1f * (rng.uniform() - 0.5f); };
        const float expected = (uv.x + 2 * uv.y) * 64 - 1.5f;
        EXPECT_NEAR(texels.ewa(uv, {part(), part()}, {part(), part()}, 8, value), expected, 1.0f);
    }
}

TEST_F(TextureTest, FiltersTakeTheLevelOfThePixel) {
    save("stripes.exr", stripes(64));
    for (const char* filter : {"point", "bilinear", "trilinear", "ewa"}) {
        textures = {};
        build({texture_node("imagemap",
                            {make_string("filename", "stripes.exr"), make_string("filter", filter)}, false)});
        auto node = textures.find_float("t");
        ASSERT_TRUE(node) << first_message();
        // (31 + 1/2) / 64 is the middle of a white stripe.
        const Looking near({0.984375f, 0.5f, 0.01f}, 0.01f, {0.984375f, 0.5f, 0}),
            far({0.984375f, 0.5f, 20}, 0.01f, {0.984375f, 0.5f, 0});
        EXPECT_NEAR(node->eval(near.point()), 1, 1e-4f) << filter;
        EXPECT_NEAR(node->eval(far.point()), 0.5f, 1e-3f) << filter;
    }
}

TEST_F(TextureTest, SquaresBlendWhereThePixelIsWide) {
    build({texture_node("checkerboard", {make_float("uscale", 2)}, false)});
    auto node = textures.find_float("t");
    ASSERT_TRUE(node) << first_message();
    // Squares with sides of 1 in x and y. The blend is the mean over a tent, here by brute force.
    Rng rng(2);
    for (float width : {0.05f, 0.3f, 1.0f, 3.0f})
        for (int i = 0; i < 20; ++i) {
            const Vec3 p{4 * rng.uniform() - 2, 4 * rng.uniform() - 2, 0};
            const Looking at(p + Vec3(0, 0, 10), width / 10, p);
            const double r = 1.5 * static_cast<double>(width);
            double sum = 0, weights = 0;
            constexpr int n = 200;
            for (int a = 0; a < n; ++a)
                for (int b = 0; b < n; ++b) {
                    const double dx = (2 * (a + 0.5) / n - 1) * r, dy = (2 * (b + 0.5) / n - 1) * r;
                    const double weight = (r - std::abs(dx)) * (r - std::abs(dy));
                    const bool even = (static_cast<int>(std::floor(static_cast<double>(p.x) + dx)) +
                                       static_cast<int>(std::floor(static_cast<double>(p.y) + dy))) %
                                          2 ==
                                      0;
                    weights += weight;
                    sum += weight * (even ? 1 : 0);
                }
            EXPECT_NEAR(static_cast<double>(node->eval(at.point())), sum / weights, 0.02) << width;
        }
}

TEST_F(TextureTest, SquaresSeenFromCloseByHaveFineEdges) {
    build({texture_node("checkerboard", {make_float("uscale", 2)}, false)});
    auto node = textures.find_float("t");
    ASSERT_TRUE(node) << first_message();
    for (float width : {1e-2f, 1e-3f, 1e-4f, 1e-5f})
        for (float edge : {0.0f, 1.0f, -3.0f}) {
            float before = edge == 1.0f || edge == -3.0f ? 1.0f : 0.0f;
            for (int i = -40; i <= 40; ++i) {
                const Vec3 p{edge + static_cast<float>(i) * width / 20, 0.5f, 0};
                const Looking at(p + Vec3(0, 0, 10), width / 10, p);
                const float value = node->eval(at.point());
                ASSERT_GE(value, 0);
                ASSERT_LE(value, 1);
                // From one colour to the other and not back.
                EXPECT_LE((value - before) * (edge == 0 ? -1.0f : 1.0f), 2e-3f) << width << " " << edge;
                before = value;
            }
        }
}

TEST(Noise, OctavesTooFineForThePixelAreTheirMean) {
    Rng rng(3);
    double fine = 0, wide = 0, half = 0;
    constexpr int n = 20000;
    for (int i = 0; i < n; ++i) {
        const Vec3 p{100 * rng.uniform(), 100 * rng.uniform(), 100 * rng.uniform()};
        EXPECT_EQ(fractal_noise(p, 0.5f, 8, 2), 0);
        EXPECT_EQ(fractal_noise(p, 0.5f, 8, 1e-6f), fractal_noise(p, 0.5f, 8));
        // The first octave's mean, once too often.
        EXPECT_FLOAT_EQ(turbulence(p, 0.5f, 8, 2), 0.2f + 0.2f * (2 - 0x1p-7f));
        fine += static_cast<double>(turbulence(p, 0.5f, 8)) / n;
        // Nine octaves are seen of twelve, and the tenth's mean counts twice.
        half += static_cast<double>(turbulence(p, 0.5f, 12, 0x1p-10f)) / n;
        wide += static_cast<double>(turbulence(p, 0.5f, 8, 10)) / n;
    }
    EXPECT_NEAR(half / fine, 1, 0.01);
    EXPECT_NEAR((wide - 0.2) / fine, 1, 0.2);
}

} // namespace

} // namespace alhazen
