/// Noise, and the textures made of it.
#include "textures/noise.h"

#include <set>

#include "base/hash.h"
#include "tests/unit/textures/support.h"

namespace alhazen {
namespace {

constexpr std::array<int, 256> permutation = {
#include "textures/data/perlin_permutation.inl"
};

TEST(Noise, ItsTableIsAPermutation) {
    std::set<int> numbers(permutation.begin(), permutation.end());
    EXPECT_EQ(numbers.size(), 256u);
    EXPECT_EQ(*numbers.begin(), 0);
    EXPECT_EQ(*numbers.rbegin(), 255);
}

// By hand: gradients of Perlin's twelve directions, by the formula of his article at the middle of the first
// cube, where all eight weights are equal.
TEST(Noise, IsTheMeanOfEightGradientsInACubesMiddle) {
    auto p = [](int i) { return permutation[static_cast<std::size_t>(i & 255)]; };
    const int directions[16][3] = {{1, 1, 0},  {-1, 1, 0},  {1, -1, 0}, {-1, -1, 0}, {1, 0, 1},  {-1, 0, 1},
                                   {1, 0, -1}, {-1, 0, -1}, {0, 1, 1},  {0, -1, 1},  {0, 1, -1}, {0, -1, -1},
                                   {1, 1, 0},  {-1, 1, 0},  {0, -1, 1}, {0, -1, -1}};
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
        const int* g = directions[p(p(p(i) + j) + k) & 15];
        sum += (g[0] * (0.5 - i) + g[1] * (0.5 - j) + g[2] * (0.5 - k)) / 8;
    }
    EXPECT_NEAR(noise(Vec3(0.5f)), sum, 1e-6);
}

TEST(Noise, IsZeroAtWholeCoordinatesAndRepeats) {
    Rng rng(1);
    for (int i = 0; i < 1000; ++i) {
        auto whole = [&] { return static_cast<float>(rng.below(2000)) - 1000; };
        EXPECT_EQ(noise({whole(), whole(), whole()}), 0);
        Vec3 p{rng.uniform(), rng.uniform(), rng.uniform()};
        p = p * 4;
        EXPECT_NEAR(noise(p), noise(p + Vec3{256, -512, 1024}), 2e-3);
    }
}

TEST(Noise, IsSmoothBoundedAndFinite) {
    Rng rng(2);
    double largest = 0, sum = 0;
    for (int i = 0; i < 100000; ++i) {
        Vec3 p = Vec3{rng.uniform(), rng.uniform(), rng.uniform()} * 100 - Vec3(50);
        const double n = noise(p);
        largest = std::max(largest, std::abs(n));
        sum += n;
        EXPECT_NEAR(n, noise(p + Vec3(1e-3f)), 2e-2);
    }
    EXPECT_LT(largest, 1.1);
    EXPECT_GT(largest, 0.8);
    // Of mean 0: its standard deviation is 0.27, and neighbours within a cube's size are alike.
    EXPECT_NEAR(sum / 100000, 0, 5 * 0.27 / std::sqrt(100000));
    for (float huge : {1e10f, -3e38f, 1e-40f}) EXPECT_TRUE(std::isfinite(noise({huge, 0.3f, -huge})));
}

TEST(Noise, OctavesAddUp) {
    const Vec3 p{0.3f, 1.7f, -2.2f};
    EXPECT_EQ(fractal_noise(p, 0.5f, 1), noise(p));
    EXPECT_FLOAT_EQ(fractal_noise(p, 0.25f, 2), noise(p) + 0.25f * noise(p * 1.99f));
    // And the mean of one more, as in pbrt-v4.
    EXPECT_FLOAT_EQ(turbulence(p, 0.25f, 2),
                    std::abs(noise(p)) + 0.25f * std::abs(noise(p * 1.99f)) + 0.0625f * 0.2f);
}

using NoiseTextures = TextureTest;

TEST_F(NoiseTextures, FbmWrinkledAndWindyAreWhatTheySay) {
    const Vec3 p{0.3f, 1.7f, -2.2f};
    auto value = [&](const char* kind, std::vector<Parameter> parameters) {
        TextureNode node = texture_node(kind, std::move(parameters), false);
        node.world_from_texture.start = Matrix4::scale({2, 2, 2});
        TextureSet set;
        BuildContext context{messages};
        set.build({node}, context);
        return set.find_float("t")->eval(at_point(p * 2));
    };
    EXPECT_FLOAT_EQ(value("fbm", {make_integer("octaves", 3), make_float("roughness", 0.7f)}),
                    fractal_noise(p, 0.7f, 3));
    EXPECT_FLOAT_EQ(value("wrinkled", {}), turbulence(p, 0.5f, 8));
    EXPECT_FLOAT_EQ(value("windy", {}),
                    std::abs(fractal_noise(p * 0.1f, 0.5f, 3)) * fractal_noise(p, 0.5f, 6));
    EXPECT_EQ(messages.error_count(), 0u);
}

TEST_F(NoiseTextures, MarbleHasDarkVeins) {
    build({texture_node("marble", {make_float("variation", 0)}, false)});
    auto node = textures.find_float("t");
    float least = 1, most = 0;
    for (int i = 0; i < 1000; ++i) {
        const float y = 2 * pi * (static_cast<float>(i) + 0.37f) / 1000;
        const float v = node->eval(at_point({3, y, -1}));
        EXPECT_NEAR(v, node->eval(at_point({-7, y + 2 * pi, 5})), 1e-4);
        least = std::min(least, v);
        most = std::max(most, v);
    }
    EXPECT_LT(least, 0.7f);
    EXPECT_GT(most, 0.85f);
}

TEST_F(NoiseTextures, DotsAreRoundAndOnTwoFifthsOfTheSquares) {
    build({texture_node("dots", {}, false)});
    auto node = textures.find_float("t");
    Rng rng(3);
    int inside = 0;
    constexpr int n = 200000;
    for (int i = 0; i < n; ++i) inside += node->eval(at_uv(100 * rng.uniform(), 100 * rng.uniform())) == 0;
    // In a square's middle the noise is the mean of eight numbers -1, 0 or 1 with chances 1/4, 1/2, 1/4, so 0
    // with chance binomial(16, 8) / 2^16 and above it with half of the rest; a dot has the radius 0.35. 10^4
    // squares have a standard deviation of 0.002.
    const double chance = (1 - 12870.0 / 65536) / 2;
    EXPECT_NEAR(static_cast<double>(inside) / n, chance * 3.14159265 * 0.35 * 0.35, 0.01);
}

} // namespace
} // namespace alhazen
