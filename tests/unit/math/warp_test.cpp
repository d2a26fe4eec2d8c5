// Every warp against its density by a chi-square test (false-alarm rate: see density_test.h), and against its
// inverse.
#include "math/warp.h"

#include <gtest/gtest.h>

#include "math/equal_area.h"
#include "tests/support/density_test.h"

namespace alhazen {
namespace {

using testing_support::chi_square_1d;
using testing_support::chi_square_2d;
using testing_support::p_threshold;

constexpr double pi_d = 3.14159265358979323846;

// z and longitude: their rectangle has the sphere's own area (Archimedes), so densities carry over.
Vec2 z_and_phi(Vec3 w) {
    float phi = std::atan2(w.y, w.x);
    return {w.z, phi < 0 ? phi + 2 * pi : phi};
}
// r^2 / 2 and angle: the same for the disk.
Vec2 area_and_phi(Vec2 p) {
    float phi = std::atan2(p.y, p.x);
    return {0.5f * dot(p, p), phi < 0 ? phi + 2 * pi : phi};
}

template <class Sample, class Invert>
void expect_inverse(Sample sample, Invert invert, float tolerance) {
    Rng rng(7);
    for (int i = 0; i < 2000; ++i) {
        Vec2 u{rng.uniform(), rng.uniform()};
        Vec2 back = invert(sample(u));
        ASSERT_NEAR(back.x, u.x, tolerance) << u.x << " " << u.y;
        ASSERT_NEAR(back.y, u.y, tolerance) << u.x << " " << u.y;
    }
}

TEST(Warp, Disk) {
    EXPECT_GT(chi_square_2d([](Vec2 u) { return area_and_phi(sample_disk(u)); },
                            [](Vec2) { return disk_pdf(); }, {0, 0.5, 0, 2 * pi_d}),
              p_threshold);
    expect_inverse(sample_disk, invert_disk, 1e-5f);
    EXPECT_EQ(sample_disk({0.5f, 0.5f}), Vec2(0, 0));
    EXPECT_EQ(invert_disk({0, 0}), Vec2(0.5f, 0.5f));
    for (Vec2 corner : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1)})
        EXPECT_NEAR(length(sample_disk(corner)), 1, 1e-6f);
}

TEST(Warp, Hemisphere) {
    EXPECT_GT(chi_square_2d([](Vec2 u) { return z_and_phi(sample_hemisphere(u)); },
                            [](Vec2) { return hemisphere_pdf(); }, {0, 1, 0, 2 * pi_d}),
              p_threshold);
    expect_inverse(sample_hemisphere, invert_hemisphere, 1e-5f);
}

TEST(Warp, CosineHemisphere) {
    EXPECT_GT(chi_square_2d([](Vec2 u) { return z_and_phi(sample_cosine_hemisphere(u)); },
                            [](Vec2 p) { return cosine_hemisphere_pdf(p.x); }, {0, 1, 0, 2 * pi_d}),
              p_threshold);
    expect_inverse(sample_cosine_hemisphere, invert_cosine_hemisphere, 1e-5f);
    EXPECT_EQ(cosine_hemisphere_pdf(-0.5f), 0);
}

TEST(Warp, Sphere) {
    EXPECT_GT(chi_square_2d([](Vec2 u) { return z_and_phi(sample_sphere(u)); },
                            [](Vec2) { return sphere_pdf(); }, {-1, 1, 0, 2 * pi_d}),
              p_threshold);
    expect_inverse(sample_sphere, invert_sphere, 1e-5f);
}

TEST(Warp, Cone) {
    for (float h : {1.5f, 1.0f, 0.3f, 1e-3f}) {
        EXPECT_GT(chi_square_2d([h](Vec2 u) { return Vec2((1 - sample_cone(u, h).z) / h, u.y); },
                                [h](Vec2) { return cone_pdf(h) * h * 2 * pi; }, {}),
                  p_threshold)
            << h;
        expect_inverse([h](Vec2 u) { return sample_cone(u, h); }, [h](Vec3 w) { return invert_cone(w, h); },
                       1e-4f);
    }
}

TEST(Warp, NarrowConeKeepsItsDigits) {
    // sin^2 of an angle of 1e-4: 1 - cos would round to a multiple of 6e-8, that is, to 12 % of the angle.
    float h = one_minus_cos_from_sin2(1e-8f);
    EXPECT_NEAR(h, 0.5e-8f, 1e-14f);
    Vec3 edge = sample_cone({1, 0}, h);
    EXPECT_NEAR(edge.x, 1e-4f, 1e-9f);
}

TEST(Warp, Triangle) {
    // (1 - b0)^2 and b1 / (1 - b0) are uniform when the point is.
    EXPECT_GT(chi_square_2d(
                  [](Vec2 u) {
                      Vec3 b = sample_triangle(u);
                      EXPECT_NEAR(b.x + b.y + b.z, 1, 1e-6f);
                      EXPECT_GE(std::min(b.x, std::min(b.y, b.z)), -1e-7f);
                      return Vec2(sqr(1 - b.x), b.y / (1 - b.x));
                  },
                  [](Vec2) { return 1; }, {}),
              p_threshold);
    expect_inverse(sample_triangle, invert_triangle, 1e-5f);
}

TEST(Warp, DirectionsHaveUnitLength) {
    Rng rng(3);
    for (int i = 0; i < 5000; ++i) {
        Vec2 u{rng.uniform(), rng.uniform()};
        for (Vec3 w : {sample_sphere(u), sample_hemisphere(u), sample_cosine_hemisphere(u),
                       sample_cone(u, 0.01f), equal_area_to_sphere(u)})
            ASSERT_NEAR(length(w), 1, 1e-6f);
    }
}

TEST(EqualArea, IsUniformAndInvertible) {
    EXPECT_GT(chi_square_2d([](Vec2 u) { return z_and_phi(equal_area_to_sphere(u)); },
                            [](Vec2) { return sphere_pdf(); }, {-1, 1, 0, 2 * pi_d}),
              p_threshold);
    expect_inverse(equal_area_to_sphere, sphere_to_equal_area, 1e-5f);
}

TEST(EqualArea, KnownPlaces) {
    struct Known {
        Vec2 p;
        Vec3 w;
    };
    const Known known[] = {{{.5f, .5f}, {0, 0, 1}}, {{0, 0}, {0, 0, -1}},  {{1, .5f}, {1, 0, 0}},
                           {{0, .5f}, {-1, 0, 0}},  {{.5f, 1}, {0, 1, 0}}, {{.5f, 0}, {0, -1, 0}}};
    for (const Known& k : known) EXPECT_NEAR(length(equal_area_to_sphere(k.p) - k.w), 0, 1e-6f);
    EXPECT_NEAR(length(equal_area_to_sphere({1, 1}) - Vec3(0, 0, -1)), 0, 1e-6f);
}

TEST(EqualArea, WrappingContinuesAcrossTheEdges) {
    // A small step over an edge is a small step on the sphere.
    Rng rng(5);
    for (int i = 0; i < 1000; ++i) {
        float a = rng.uniform();
        for (Vec2 inside : {Vec2(1e-4f, a), Vec2(1 - 1e-4f, a), Vec2(a, 1e-4f), Vec2(a, 1 - 1e-4f)}) {
            Vec2 step = inside.x < 0.001f   ? Vec2(-2e-4f, 0)
                        : inside.x > 0.999f ? Vec2(2e-4f, 0)
                        : inside.y < 0.001f ? Vec2(0, -2e-4f)
                                            : Vec2(0, 2e-4f);
            Vec2 wrapped = wrap_equal_area(inside + step);
            ASSERT_TRUE(wrapped.x >= 0 && wrapped.x <= 1 && wrapped.y >= 0 && wrapped.y <= 1);
            ASSERT_LT(length(equal_area_to_sphere(wrapped) - equal_area_to_sphere(inside)), 5e-3f);
        }
    }
}

TEST(EqualArea, TexelsWrapLikePlaces) {
    constexpr int n = 8;
    for (int i = 0; i < n; ++i)
        for (Vec2i p : {Vec2i(-1, i), Vec2i(n, i), Vec2i(i, -1), Vec2i(i, n)}) {
            Vec2i w = wrap_equal_area(p, n);
            Vec2 place = wrap_equal_area(
                Vec2((static_cast<float>(p.x) + .5f) / n, (static_cast<float>(p.y) + .5f) / n));
            EXPECT_EQ(w, Vec2i(static_cast<int>(place.x * n), static_cast<int>(place.y * n)));
        }
}

TEST(Density, Exponential) {
    auto sample = [](float u) { return sample_exponential(u, 2); };
    EXPECT_GT(chi_square_1d(
                  sample, [](float x) { return exponential_pdf(x, 2); }, 0, 3),
              p_threshold);
    for (float u : {0.0f, 0.1f, 0.5f, 0.999f}) EXPECT_NEAR(invert_exponential(sample(u), 2), u, 1e-6f);
    EXPECT_TRUE(std::isfinite(sample_exponential(one_minus_epsilon, 1)));
}

TEST(Density, Tent) {
    auto sample = [](float u) { return sample_tent(u, 1.5f); };
    EXPECT_GT(chi_square_1d(
                  sample, [](float x) { return tent_pdf(x, 1.5f); }, -1.5, 1.5),
              p_threshold);
    for (float u : {0.0f, 0.1f, 0.5f, 0.9f}) EXPECT_NEAR(invert_tent(sample(u), 1.5f), u, 1e-6f);
}

TEST(Density, Normal) {
    auto sample = [](float u) { return sample_normal(u, 1, 0.5f); };
    EXPECT_GT(chi_square_1d(
                  sample, [](float x) { return normal_pdf(x, 1, 0.5f); }, -2, 4),
              p_threshold);
    for (float u : {0.01f, 0.1f, 0.5f, 0.99f}) EXPECT_NEAR(invert_normal(sample(u), 1, 0.5f), u, 1e-5f);
    EXPECT_TRUE(std::isfinite(sample_normal(0)));
    EXPECT_GT(chi_square_2d([](Vec2 u) { return sample_two_normals(u); },
                            [](Vec2 p) { return normal_pdf(p.x) * normal_pdf(p.y); }, {-6, 6, -6, 6}),
              p_threshold);
}

TEST(Density, Linear) {
    for (Vec2 ab : {Vec2(1, 3), Vec2(2, 0), Vec2(0, 1), Vec2(1, 1), Vec2(0, 0)}) {
        auto sample = [ab](float u) { return sample_linear(u, ab.x, ab.y); };
        EXPECT_GT(chi_square_1d(
                      sample, [ab](float x) { return linear_pdf(x, ab.x, ab.y); }, 0, 1),
                  p_threshold)
            << ab.x << " " << ab.y;
        for (float u : {0.0f, 0.1f, 0.5f, 0.9f}) EXPECT_NEAR(invert_linear(sample(u), ab.x, ab.y), u, 1e-6f);
        EXPECT_LT(sample(one_minus_epsilon), 1);
    }
}

TEST(Density, SmoothStep) {
    EXPECT_GT(testing_support::chi_square_1d(
                  sample_smooth_step, [](float x) { return smooth_step_pdf(x); }, 0, 1),
              p_threshold);
    for (float u : {0.0f, 1e-30f, 1e-6f, 0.3f, 0.5f, 0.999f, one_minus_epsilon, 1.0f})
        EXPECT_NEAR(invert_smooth_step(sample_smooth_step(u)), u, 2e-6f);
    EXPECT_EQ(sample_smooth_step(0), 0);
}

TEST(Density, Bilinear) {
    for (const BilinearHeights& w : {BilinearHeights{1, 2, 3, 4}, BilinearHeights{0, 1, 0, 0},
                                     BilinearHeights{5, 0, 0, 5}, BilinearHeights{0, 0, 0, 0}}) {
        EXPECT_GT(chi_square_2d([&](Vec2 u) { return sample_bilinear(u, w); },
                                [&](Vec2 p) { return bilinear_pdf(p, w); }, {}),
                  p_threshold)
            << w[0] << w[1] << w[2] << w[3];
        expect_inverse([&](Vec2 u) { return sample_bilinear(u, w); },
                       [&](Vec2 p) { return invert_bilinear(p, w); }, 1e-4f);
    }
}

// The tests' own judge: a density that is a little wrong must be found out.
TEST(ChiSquare, FindsAWrongDensity) {
    EXPECT_LT(chi_square_2d([](Vec2 u) { return z_and_phi(sample_cosine_hemisphere(u)); },
                            [](Vec2) { return hemisphere_pdf(); }, {0, 1, 0, 2 * pi_d}),
              p_threshold);
    EXPECT_LT(chi_square_1d([](float u) { return sample_linear(u, 1, 1.3f); }, [](float) { return 1; }, 0, 1),
              p_threshold);
    EXPECT_LT(chi_square_1d([](float u) { return u * 1.2f; }, [](float) { return 1; }, 0, 1), p_threshold);
}

TEST(ChiSquare, PValuesMatchTables) {
    EXPECT_NEAR(testing_support::chi_square_p_value(3.841459, 1), 0.05, 1e-6);
    EXPECT_NEAR(testing_support::chi_square_p_value(18.307038, 10), 0.05, 1e-6);
    EXPECT_NEAR(testing_support::chi_square_p_value(149.449, 100), 0.001, 1e-5);
    EXPECT_NEAR(testing_support::chi_square_p_value(70.0649, 100), 0.99, 1e-5);
}

} // namespace
} // namespace alhazen
