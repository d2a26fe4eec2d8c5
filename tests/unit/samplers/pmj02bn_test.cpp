// Progressive multi-jittered points, blue noise, and the sampler made of both.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "samplers/blue_noise.h"
#include "samplers/pmj02.h"
#include "samplers/sampler.h"
#include "tests/support/family.h"

namespace alhazen {
namespace {

// Of 2^k points, one in each rectangle of size 2^-a x 2^-(k - a), for every a.
bool is_net(const Vec2* points, int k) {
    for (int a = 0; a <= k; ++a) {
        std::vector<bool> taken(std::size_t{1} << k);
        for (int i = 0; i < 1 << k; ++i) {
            const auto x = static_cast<std::size_t>(points[i].x * static_cast<float>(1 << a));
            const auto y = static_cast<std::size_t>(points[i].y * static_cast<float>(1 << (k - a)));
            const std::size_t cell = (y << a) + x;
            if (taken.at(cell)) return false;
            taken[cell] = true;
        }
    }
    return true;
}

TEST(Pmj02, EveryPrefixOfAPowerOfTwoIsANet) {
    for (std::uint64_t seed : {0u, 1u, 77u}) {
        const std::vector<Vec2> points = pmj02_points(16, seed);
        ASSERT_EQ(points.size(), 65536u);
        for (int k = 0; k <= 16; ++k) EXPECT_TRUE(is_net(points.data(), k)) << k;
        // And so is every run that such a prefix is the first of.
        for (std::size_t run = 0; run < 4096; run += 16) ASSERT_TRUE(is_net(&points[run], 4));
    }
}

TEST(Pmj02, IsRandomAndRepeatable) {
    EXPECT_EQ(pmj02_points(6, 3), pmj02_points(6, 3));
    // The first point is anywhere, and the seventh too, whatever the first.
    Vec2 mean;
    double product = 0;
    constexpr int n = 4000;
    for (std::uint64_t seed = 0; seed < n; ++seed) {
        const auto points = pmj02_points(3, seed);
        mean += points[6] * (1.0f / n);
        product += static_cast<double>((points[6].x - 0.5f) * (points[0].y - 0.5f));
    }
    // Five standard deviations: 1 / sqrt(12 n), and sqrt(n) / 12.
    EXPECT_NEAR(mean.x, 0.5, 5 / std::sqrt(12.0 * n));
    EXPECT_NEAR(mean.y, 0.5, 5 / std::sqrt(12.0 * n));
    EXPECT_LT(std::abs(product), 5 * std::sqrt(static_cast<double>(n)) / 12);
}

TEST(BlueNoise, HasEachRankOnce) {
    std::vector<bool> seen(BlueNoise::side * BlueNoise::side);
    for (int y = 0; y < BlueNoise::side; ++y)
        for (int x = 0; x < BlueNoise::side; ++x) {
            const int rank = BlueNoise::get().rank(x, y);
            ASSERT_FALSE(seen.at(static_cast<std::size_t>(rank)));
            seen[static_cast<std::size_t>(rank)] = true;
        }
}

TEST(BlueNoise, KeepsEqualNumbersApart) {
    const BlueNoise& noise = BlueNoise::get();
    constexpr int side = BlueNoise::side;
    // Of the lowest share of ranks, the nearest pair. Of a hexagonal lattice it would be 1.07 / sqrt(share).
    for (double share : {0.01, 0.04, 0.08}) {
        std::vector<Vec2i> points;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x)
                if (noise.rank(x, y) < share * side * side) points.push_back({x, y});
        double nearest = side;
        for (const Vec2i a : points)
            for (const Vec2i b : points) {
                if (a == b) continue;
                const auto gap = [](int d) { return std::min(std::abs(d), side - std::abs(d)); };
                nearest = std::min(nearest, std::hypot(gap(a.x - b.x), gap(a.y - b.y)));
            }
        EXPECT_GT(nearest, 0.55 / std::sqrt(share)) << share;
    }
    // Means of 4 x 4 pixels vary less than the 1 / (12 * 16) of numbers by chance.
    double variance = 0;
    for (int y = 0; y < side; y += 4)
        for (int x = 0; x < side; x += 4) {
            double mean = 0;
            for (int i = 0; i < 16; ++i)
                mean += (noise.rank(x + i % 4, y + i / 4) + 0.5) / (side * side) / 16;
            variance += (mean - 0.5) * (mean - 0.5) / (side * side / 16);
        }
    EXPECT_LT(variance, 0.25 / (12 * 16));
}

TEST(BlueNoise, DimensionsAreNotTied) {
    const BlueNoise& noise = BlueNoise::get();
    constexpr int side = BlueNoise::side;
    for (std::uint32_t a = 0; a < 60; ++a)
        for (std::uint32_t b = a + 1; b < 60; ++b) {
            double sum = 0;
            for (int y = 0; y < side; y += 2)
                for (int x = 0; x < side; x += 2)
                    sum += static_cast<double>((noise.at({x, y}, a, 5) - 0.5f) *
                                               (noise.at({x, y}, b, 5) - 0.5f));
            ASSERT_LT(std::abs(sum) * 12 / (side * side / 4), 0.1) << a << ", " << b;
        }
    EXPECT_NE(noise.at({1, 2}, 3, 4), noise.at({1, 2}, 3, 5));
    EXPECT_EQ(noise.at({1, 2}, 3, 4), noise.at({1 + side, 2 + 3 * side}, 3, 4));
}

std::unique_ptr<Sampler> pmj02bn(int spp, std::uint64_t seed = 1) {
    auto sampler = testing_support::make_member(sampler_kinds(), "pmj02bn", {});
    sampler->prepare({64, 64}, spp, seed);
    return sampler;
}

TEST(Pmj02bn, PlacesInEachPixelAreNets) {
    for (int k : {0, 2, 4, 8, 12, 16}) {
        const auto sampler = pmj02bn(1 << k);
        for (Vec2i pixel : {Vec2i(0, 0), Vec2i(13, 5), Vec2i(63, 62)}) {
            std::vector<Vec2> points;
            for (std::uint32_t i = 0; i < 1u << k; ++i)
                points.push_back(SampleStream(*sampler, pixel, i).pixel2());
            EXPECT_TRUE(is_net(points.data(), k)) << k;
        }
    }
}

TEST(Pmj02bn, PixelsHaveTheSamePointsButForAnOffset) {
    const auto sampler = pmj02bn(16);
    Vec2 offset;
    for (std::uint32_t i = 0; i < 16; ++i) {
        SampleStream a(*sampler, {3, 4}, i), b(*sampler, {30, 4}, i);
        a.pixel2();
        b.pixel2();
        const Vec2 u = a.next2(), v = b.next2();
        const Vec2 moved{v.x - u.x - std::floor(v.x - u.x), v.y - u.y - std::floor(v.y - u.y)};
        if (i == 0) offset = moved;
        EXPECT_NEAR(moved.x, offset.x, 1e-6f);
        EXPECT_NEAR(moved.y, offset.y, 1e-6f);
    }
    EXPECT_GT(offset.x, 0.001f);
}

// A path takes its four wavelengths a quarter of the range apart: those of 4 samples must not coincide.
TEST(Pmj02bn, SingleNumbersAreStratifiedAndNotEquallySpaced) {
    for (int spp : {4, 16}) {
        const auto sampler = pmj02bn(spp);
        std::vector<float> cells, quarters;
        for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(spp); ++i) {
            SampleStream stream(*sampler, {9, 9}, i);
            stream.pixel2();
            const float u = stream.next1();
            cells.push_back(std::floor(u * static_cast<float>(spp)));
            quarters.push_back(4 * u - std::floor(4 * u));
        }
        std::sort(cells.begin(), cells.end());
        std::sort(quarters.begin(), quarters.end());
        for (int i = 0; i < spp; ++i) EXPECT_EQ(cells[static_cast<std::size_t>(i)], static_cast<float>(i));
        for (std::size_t i = 1; i < quarters.size(); ++i)
            EXPECT_GT(quarters[i] - quarters[i - 1], 0.1f / static_cast<float>(spp));
    }
}

// Errors of neighbours are of either sign: blocks of 4 x 4 pixels have less than half of the sixteenth of a
// pixel's variance that independent errors would leave.
TEST(Pmj02bn, ErrorsAreBlue) {
    constexpr int spp = 4, size = 64;
    double pixel_variance = 0, block_variance = 0;
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
        const auto sampler = pmj02bn(spp, seed);
        auto error = [&](Vec2i pixel) {
            double sum = 0;
            for (std::uint32_t i = 0; i < spp; ++i) {
                SampleStream stream(*sampler, pixel, i);
                stream.pixel2();
                const Vec2 u = stream.next2();
                sum += static_cast<double>(u.x + 0.5f * u.y) / 1.5;
            }
            return sum / spp - 0.5;
        };
        for (int y = 0; y < size; y += 4)
            for (int x = 0; x < size; x += 4) {
                double block = 0;
                for (int i = 0; i < 16; ++i) {
                    const double e = error({x + i % 4, y + i / 4});
                    pixel_variance += e * e / (4 * size * size);
                    block += e / 16;
                }
                block_variance += block * block / (4.0 * size * size / 16);
            }
    }
    EXPECT_LT(block_variance, 0.5 * pixel_variance / 16);
}

} // namespace
} // namespace alhazen
