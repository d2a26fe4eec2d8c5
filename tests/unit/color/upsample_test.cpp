#include "color/upsample.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "color/upsample_many.h"

namespace alhazen {
namespace {

bool same(SigmoidCoefficients a, SigmoidCoefficients b) {
    return a.c0 == b.c0 && a.c1 == b.c1 && a.c2 == b.c2;
}

/// Linear RGB of a surface with this reflectance under the space's illuminant, from the sums over whole nm.
Vec3d shown(const RgbColorSpace& space, const SigmoidCoefficients& c) {
    Vec3d xyz;
    double white = 0;
    for (float lambda = lambda_min; lambda <= lambda_max; ++lambda) {
        Vec3d observed = Vec3d(cie_x().eval(lambda), cie_y().eval(lambda), cie_z().eval(lambda)) *
                         static_cast<double>(space.illuminant->eval(lambda));
        xyz += observed * static_cast<double>(c.eval(lambda));
        white += observed.y;
    }
    return space.rgb_from_xyz * (xyz / white);
}

double round_trip_error(const RgbColorSpace& space, Vec3 rgb) {
    return max_component(abs(shown(space, upsample(space, rgb)) - Vec3d(rgb)));
}

TEST(Upsample, SrgbComesBackOverTheWholeCube) {
    constexpr int steps = 16;
    int beyond_aim = 0;
    for (int r = 0; r <= steps; ++r) {
        for (int g = 0; g <= steps; ++g) {
            for (int b = 0; b <= steps; ++b) {
                Vec3 rgb = Vec3(Vec3i(r, g, b)) / steps;
                double error = round_trip_error(srgb_space(), rgb);
                EXPECT_LT(error, 2e-3) << rgb.x << ' ' << rgb.y << ' ' << rgb.z;
                beyond_aim += error > 1e-4;
            }
        }
    }
    // Colours within a few hundredths of white have spectra steeper than the nodes resolve.
    EXPECT_LE(beyond_aim, 5);
}

TEST(Upsample, DarkColorsComeBack) {
    Rng rng(3);
    for (int i = 0; i < 500; ++i) {
        Vec3 rgb = Vec3(rng.uniform(), rng.uniform(), rng.uniform()) * 0.02f;
        EXPECT_LT(round_trip_error(srgb_space(), rgb), 5e-5);
    }
}

// Every reflectance of the sRGB cube is one in the wider spaces too, where the fit must find it.
TEST(Upsample, SrgbColorsComeBackInWiderSpaces) {
    Rng rng(4);
    for (const char* name : {"dci-p3", "rec2020"}) {
        const RgbColorSpace& space = *find_color_space(name);
        for (int i = 0; i < 500; ++i) {
            Vec3 srgb = Vec3(rng.uniform(), rng.uniform(), rng.uniform()) * 0.95f;
            EXPECT_LT(round_trip_error(space, convert_rgb(srgb_space(), space) * srgb), 2e-3) << name;
        }
    }
}

TEST(Upsample, AcesColorsOfModestSaturationComeBack) {
    const RgbColorSpace& space = *find_color_space("aces2065-1");
    Rng rng(5);
    for (int i = 0; i < 500; ++i) {
        Vec3 rgb = Vec3(0.3f) + Vec3(rng.uniform(), rng.uniform(), rng.uniform()) * 0.25f;
        EXPECT_LT(round_trip_error(space, rgb), 1e-3);
    }
}

TEST(Upsample, ImpossibleColorsGiveFiniteSpectra) {
    const RgbColorSpace& space = *find_color_space("aces2065-1");
    for (Vec3 rgb : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 1, 1), Vec3(0, 1, 0), Vec3(1, 0, 1)}) {
        SigmoidCoefficients c = upsample(space, rgb);
        for (float lambda = lambda_min; lambda <= lambda_max; lambda += 5) {
            EXPECT_GE(c.eval(lambda), 0);
            EXPECT_LE(c.eval(lambda), 1);
        }
    }
}

TEST(Upsample, GreyIsFlatAndBlackAndWhiteExact) {
    for (float v : {0.0f, 1e-4f, 0.18f, 0.5f, 0.99f, 1.0f}) {
        SigmoidCoefficients c = upsample(srgb_space(), Vec3(v));
        for (float lambda = lambda_min; lambda <= lambda_max; lambda += 47)
            EXPECT_NEAR(c.eval(lambda), v, 2e-7f);
    }
    EXPECT_EQ(SigmoidCoefficients::grey(0).eval(500.0f), 0);
    EXPECT_EQ(SigmoidCoefficients::grey(1).eval(500.0f), 1);
    EXPECT_EQ(SigmoidCoefficients::grey(-3).eval(500.0f), 0);
}

TEST(Upsample, ComponentsAreClamped) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(same(upsample(srgb_space(), {2, 0.5f, -1}), upsample(srgb_space(), {1, 0.5f, 0})));
    EXPECT_TRUE(same(upsample(srgb_space(), {nan, 0.5f, 0.2f}), upsample(srgb_space(), {0, 0.5f, 0.2f})));
}

// Colours as pictures have them: with all, none or little saturation, bright and dark.
std::vector<Vec3> many_colors(std::size_t count) {
    Rng rng(6);
    std::vector<Vec3> colors;
    while (colors.size() < count) {
        Vec3 rgb(rng.uniform(), rng.uniform(), rng.uniform());
        if (rng.uniform() < 0.5f) rgb = lerp(rng.uniform(), Vec3(rng.uniform()), rgb);
        if (rng.uniform() < 0.5f) rgb = rgb * rgb.x;
        colors.push_back(rgb);
        if (rng.uniform() < 0.1f) colors.push_back(Vec3(rgb.y));
        if (rng.uniform() < 0.1f) colors.push_back(rgb);
    }
    return colors;
}

TEST(Upsample, ManyColorsComeBackWithinTheBound) {
    const std::vector<Vec3> colors = many_colors(10000);
    std::vector<SigmoidCoefficients> out(colors.size());
    upsample(srgb_space(), colors, out);
    int alike = 0;
    for (std::size_t i = 0; i < colors.size(); ++i) {
        const double error = max_component(abs(shown(srgb_space(), out[i]) - Vec3d(colors[i])));
        // Next to white one colour alone is further off; see above.
        const double alone = round_trip_error(srgb_space(), colors[i]);
        ASSERT_LE(error, alone + upsample_error) << colors[i].x << ' ' << colors[i].y << ' ' << colors[i].z;
        alike += error < 1e-5;
    }
    EXPECT_GT(alike, 5000); // most are far better than the bound
}

TEST(Upsample, OfManyColorsEachDependsOnItselfAlone) {
    std::vector<Vec3> colors = many_colors(40000);
    std::vector<SigmoidCoefficients> all(colors.size()), some(colors.size() / 3), one(1);
    upsample(srgb_space(), colors, all);
    std::reverse(colors.begin(), colors.end());
    upsample(srgb_space(), std::span(colors).first(some.size()), some);
    for (std::size_t i = 0; i < some.size(); ++i) EXPECT_TRUE(same(some[i], all[all.size() - 1 - i]));
    for (std::size_t i = 0; i < 50; ++i) {
        upsample(srgb_space(), std::span(colors).subspan(i, 1), one);
        EXPECT_TRUE(same(one[0], some[i]));
    }
}

TEST(Upsample, WhatOnePictureLeavesBehindDoesNotChangeTheNext) {
    Rng rng(11);
    std::vector<Vec3> first(1000), second(1000);
    for (auto* colors : {&first, &second})
        for (Vec3& c : *colors) c = {rng.uniform(), rng.uniform(), rng.uniform()};
    std::vector<SigmoidCoefficients> alone(1000), after(1000);
    upsample(srgb_space(), second, alone);
    const PictureUpsampler upsampler(srgb_space());
    upsampler(first, after);
    upsampler(second, after);
    for (std::size_t i = 0; i < alone.size(); ++i) EXPECT_TRUE(same(alone[i], after[i])) << i;
}

TEST(Upsample, ManyColorsAreClampedAndGreysAreFlat) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<Vec3> colors{
        {2, 2, 2}, {-1, nan, 0}, {0.25f, 0.25f, 0.25f}, {2, 0.5f, -1}, {1, 0.5f, 0}};
    std::vector<SigmoidCoefficients> out(colors.size());
    upsample(srgb_space(), colors, out);
    EXPECT_EQ(out[0].eval(500.0f), 1);
    EXPECT_EQ(out[1].eval(500.0f), 0);
    EXPECT_NEAR(out[2].eval(400.0f), 0.25f, 2e-7f);
    EXPECT_EQ(out[3].c2, out[4].c2);
}

TEST(Upsample, MaximumBoundsTheSpectrum) {
    Rng rng(8);
    for (int i = 0; i < 100; ++i) {
        SigmoidCoefficients c = upsample(srgb_space(), {rng.uniform(), rng.uniform(), rng.uniform()});
        float seen = 0;
        for (float lambda = lambda_min; lambda <= lambda_max; lambda += 0.5f)
            seen = std::max(seen, c.eval(lambda));
        EXPECT_LE(seen, c.max_value() + 1e-6f);
        EXPECT_NEAR(seen, c.max_value(), 1e-2f);
    }
}

} // namespace
} // namespace alhazen
