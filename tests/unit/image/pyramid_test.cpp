#include "image/pyramid.h"

#include <limits>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "image/statistics.h"
#include "tests/unit/image/test_images.h"

namespace alhazen {
namespace {

constexpr WrapMode all_modes[] = {WrapMode::repeat, WrapMode::clamp, WrapMode::black,
                                  WrapMode::octahedral_sphere};

/// The octahedral map (Clarberg 2008): the square's middle is +z, its corners are -z.
Vec3 sphere_from_square(Vec2 uv) {
    float u = 2 * uv.x - 1, v = 2 * uv.y - 1;
    float z = 1 - std::abs(u) - std::abs(v);
    if (z >= 0) return normalize(Vec3{u, v, z});
    return normalize(Vec3{std::copysign(1 - std::abs(v), u), std::copysign(1 - std::abs(u), v), z});
}

TEST(WrapCoordinate, Modes) {
    Vec2i size{4, 3};
    EXPECT_EQ(wrap_coordinate(WrapMode::repeat, {-1, 3}, size), Vec2i(3, 0));
    EXPECT_EQ(wrap_coordinate(WrapMode::repeat, {-9, 8}, size), Vec2i(3, 2));
    EXPECT_EQ(wrap_coordinate(WrapMode::clamp, {-1, 7}, size), Vec2i(0, 2));
    EXPECT_EQ(wrap_coordinate(WrapMode::black, {4, 0}, size), std::nullopt);
    EXPECT_EQ(wrap_coordinate(WrapMode::octahedral_sphere, {-1, 0}, {4, 4}), Vec2i(0, 3));
    EXPECT_EQ(wrap_coordinate(WrapMode::octahedral_sphere, {1, 4}, {4, 4}), Vec2i(2, 3));
    for (WrapMode m : all_modes) EXPECT_EQ(wrap_coordinate(m, {2, 1}, size), Vec2i(2, 1));
    EXPECT_EQ(parse_wrap_mode("octahedralsphere"), WrapMode::octahedral_sphere);
    EXPECT_EQ(parse_wrap_mode("mirror"), std::nullopt);
}

TEST(WrapCoordinate, AlwaysInside) {
    for (WrapMode m : all_modes)
        for (Vec2i size : {Vec2i{1, 1}, Vec2i{2, 5}, Vec2i{8, 8}})
            for (int y = -20; y < 20; ++y)
                for (int x = -20; x < 20; ++x)
                    if (auto p = wrap_coordinate(m, {x, y}, size)) {
                        ASSERT_TRUE(p->x >= 0 && p->y >= 0 && p->x < size.x && p->y < size.y);
                    }
}

TEST(WrapCoordinate, OctahedralNeighboursAreNeighboursOnTheSphere) {
    constexpr int n = 64;
    for (int i = 0; i < n; ++i)
        for (Vec2i p : {Vec2i{0, i}, Vec2i{n - 1, i}, Vec2i{i, 0}, Vec2i{i, n - 1}})
            for (Vec2i step : {Vec2i{1, 0}, Vec2i{-1, 0}, Vec2i{0, 1}, Vec2i{0, -1}}) {
                Vec2i q = *wrap_coordinate(WrapMode::octahedral_sphere, p + step, {n, n});
                Vec2 center{0.5f, 0.5f};
                Vec3 a = sphere_from_square((Vec2(p) + center) / float(n));
                Vec3 b = sphere_from_square((Vec2(q) + center) / float(n));
                // A step of 2 / 64 moves a point of the octahedron by sqrt(2) / 32, at a distance of at least
                // 1 / sqrt(3) from the middle: sqrt(6) / 32 = 0.0765 on the sphere.
                EXPECT_LT(length(a - b), 0.077f) << p.x << ' ' << p.y << " to " << q.x << ' ' << q.y;
            }
}

TEST(BilinearTaps, WeightsAndCentres) {
    Rng rng(1);
    for (WrapMode m : all_modes)
        for (int i = 0; i < 1000; ++i) {
            Vec2 uv{rng.uniform() * 4 - 1.5f, rng.uniform() * 4 - 1.5f};
            float sum = 0;
            for (const BilinearTap& tap : bilinear_taps(m, uv, {5, 4})) {
                EXPECT_TRUE(tap.weight >= 0 && tap.weight <= 1);
                EXPECT_TRUE(tap.texel.x >= 0 && tap.texel.y >= 0 && tap.texel.x < 5 && tap.texel.y < 4);
                sum += tap.weight;
            }
            EXPECT_LE(sum, 1 + 1e-6f);
            if (m != WrapMode::black) {
                EXPECT_GE(sum, 1 - 1e-6f);
            }
        }
    // A texel's centre is that texel.
    auto taps = bilinear_taps(WrapMode::repeat, {2.5f / 5, 1.5f / 4}, {5, 4});
    EXPECT_EQ(taps[0].texel, Vec2i(2, 1));
    EXPECT_EQ(taps[0].weight, 1);
}

TEST(BilinearTaps, AnyFloatIsSafe) {
    float nan = std::numeric_limits<float>::quiet_NaN();
    for (WrapMode m : all_modes)
        for (float u : {nan, infinity, -infinity, 1e38f, -1e38f, 1e-38f, -1e-38f, 0.99999994f, 1.0f})
            for (Vec2i size : {Vec2i{1, 1}, Vec2i{65536, 3}}) {
                auto inside = [&](Vec2i p) { return p.x >= 0 && p.y >= 0 && p.x < size.x && p.y < size.y; };
                for (const BilinearTap& tap : bilinear_taps(m, {u, -u}, size))
                    EXPECT_TRUE(inside(tap.texel)) << u;
                if (auto p = nearest_texel(m, {u, -u}, size)) {
                    EXPECT_TRUE(inside(*p)) << u;
                }
            }
    EXPECT_EQ(nearest_texel(WrapMode::black, {1e38f, 0.5f}, {4, 4}), std::nullopt);
    EXPECT_EQ(nearest_texel(WrapMode::clamp, {1e38f, 0.5f}, {4, 4}), Vec2i(3, 2));
}

TEST(Pyramid, LevelsKeepTheMean) {
    Image image = noise(20, 7);
    Pyramid<Vec3> p = rgb_pyramid(image, WrapMode::clamp);
    ASSERT_EQ(p.levels(), 5);
    EXPECT_EQ(p.size(1), Vec2i(10, 3));
    EXPECT_EQ(p.size(4), Vec2i(1, 1));
    auto means = channel_means(image);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(p.texel(4, 0, 0)[c], means[static_cast<std::size_t>(c)], 1e-6);
    EXPECT_EQ(p.texel(0, 3, 2), image.rgb(3, 2));
    EXPECT_EQ(rgb_pyramid(image, WrapMode::clamp, false).levels(), 1);
}

TEST(Pyramid, LookupsInterpolate) {
    Image image = Image::grey_image(4, 4);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) image.at(x, y) = static_cast<float>(x);
    Pyramid<float> p = channel_pyramid(image, 0, WrapMode::clamp);
    EXPECT_NEAR(p.bilinear(0, {0.5f, 0.5f}), 1.5f, 1e-6f);
    EXPECT_NEAR(p.bilinear(0, {0, 0.5f}), 0, 1e-6f);
    EXPECT_EQ(p.nearest(0, {0.6f, 0.1f}), 2);
    // At u = 0.3: level 0 gives 0.7, level 1 (0.5 and 2.5 at 1/4 and 3/4) 0.7, level 2 1.5.
    EXPECT_NEAR(p.trilinear({0.3f, 0.5f}, 0), 0.7f, 1e-6f);
    EXPECT_NEAR(p.trilinear({0.3f, 0.5f}, 0.5f), 0.7f, 1e-6f);
    EXPECT_NEAR(p.trilinear({0.3f, 0.5f}, 0.5f * std::sqrt(2.0f)), (0.7f + 1.5f) / 2, 1e-6f);
    EXPECT_NEAR(p.trilinear({0.3f, 0.5f}, 100), 1.5f, 1e-6f);
    EXPECT_NEAR(p.trilinear({0.3f, 0.5f}, std::numeric_limits<float>::quiet_NaN()), 0.7f, 1e-6f);
}

TEST(Pyramid, BlackBorderIsBlack) {
    Image image = Image::grey_image(2, 2);
    for (float& v : image.values()) v = 1;
    Pyramid<float> p = channel_pyramid(image, 0, WrapMode::black);
    EXPECT_EQ(p.texel(0, -1, 0), 0);
    EXPECT_NEAR(p.bilinear(0, {0, 0.5f}), 0.5f, 1e-6f);
    EXPECT_EQ(p.bilinear(0, {3, 0.5f}), 0);
}

TEST(Pyramid, TexelsCanBeReplaced) {
    Pyramid<Vec3> rgb = rgb_pyramid(noise(8, 8), WrapMode::repeat);
    auto doubled = rgb.map([](Vec3 c) { return static_cast<double>(c.x) * 2; });
    EXPECT_NEAR(doubled.bilinear(1, {0.4f, 0.7f}, [](double d) { return static_cast<float>(d); }),
                2 * rgb.bilinear(1, {0.4f, 0.7f}).x, 1e-6f);
    EXPECT_EQ(doubled.levels(), rgb.levels());
    EXPECT_EQ(rgb.bytes(), (64 + 16 + 4 + 1) * sizeof(Vec3));
}

} // namespace
} // namespace alhazen
