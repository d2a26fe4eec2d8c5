/// Fresnel, Snell and microfacets against numbers worked out by hand.
#include <complex>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "materials/fresnel.h"
#include "materials/microfacet.h"
#include "math/warp.h"

namespace alhazen {

namespace {

TEST(Fresnel, DielectricAtNormalIncidence) {
    // ((eta - 1) / (eta + 1))^2
    EXPECT_NEAR(fresnel_dielectric(1, 1.5f), 0.04f, 1e-6f);
    EXPECT_NEAR(fresnel_dielectric(-1, 1.5f), 0.04f, 1e-6f);
    EXPECT_NEAR(fresnel_dielectric(1, 2.0f), 1.0f / 9, 1e-6f);
    EXPECT_NEAR(fresnel_dielectric(1, 1.0f), 0, 1e-12f);
}

TEST(Fresnel, DielectricAtObliqueIncidence) {
    // 60 degrees into 1.5: sin t = 0.57735, cos t = 0.81650;
    // parallel (0.75 - 0.81650) / (0.75 + 0.81650) = -0.04245, perpendicular (0.5 - 1.22474) / 1.72474 =
    // -0.42020; half the sum of the squares.
    EXPECT_NEAR(fresnel_dielectric(0.5f, 1.5f), 0.0891867f, 2e-6f);
    EXPECT_NEAR(fresnel_dielectric(1e-4f, 1.5f), 1, 1e-3f);
}

TEST(Fresnel, BrewstersAngleReflectsOnePolarisation) {
    // tan theta = eta; the perpendicular part is ((1 - eta^2) / (1 + eta^2))^2.
    float eta = 1.5f, cos_i = 1 / std::sqrt(1 + eta * eta);
    float perpendicular = (1 - eta * eta) / (1 + eta * eta);
    EXPECT_NEAR(fresnel_dielectric(cos_i, eta), sqr(perpendicular) / 2, 1e-6f);
}

TEST(Fresnel, TotalInternalReflection) {
    // The critical angle has sin = 1 / 1.5, cos = 0.745356.
    EXPECT_EQ(fresnel_dielectric(-0.74f, 1.5f), 1);
    EXPECT_LT(fresnel_dielectric(-0.75f, 1.5f), 1);
    float cos_i = 0.7f;
    Vec3 below{std::sqrt(1 - cos_i * cos_i), 0, -cos_i};
    EXPECT_FALSE(refract(below, {0, 0, 1}, 1.5f).has_value());
}

TEST(Fresnel, SnellsLaw) {
    float s = std::sin(radians(40));
    Vec3 wo{s, 0, std::cos(radians(40))};
    auto into = refract(wo, {0, 0, 1}, 1.5f);
    ASSERT_TRUE(into);
    EXPECT_NEAR(into->wt.x, -s / 1.5f, 1e-6f);
    EXPECT_LT(into->wt.z, 0);
    EXPECT_EQ(into->eta, 1.5f);
    auto back = refract(into->wt, {0, 0, 1}, 1.5f);
    ASSERT_TRUE(back);
    EXPECT_NEAR(length(back->wt - wo), 0, 1e-6f);
    EXPECT_NEAR(back->eta, 1 / 1.5f, 1e-7f);
}

TEST(Fresnel, ConductorAtNormalIncidence) {
    // ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2)
    EXPECT_NEAR(fresnel_conductor(1, 0.2f, 3.9f), (0.64f + 15.21f) / (1.44f + 15.21f), 1e-5f);
    EXPECT_NEAR(fresnel_conductor(1, 1.5f, 0), 0.04f, 1e-6f);
    EXPECT_EQ(fresnel_conductor(0.3f, 0, 0), 1);
}

TEST(Fresnel, ConductorWithoutAbsorptionIsDielectric) {
    for (float cos_i : {0.05f, 0.3f, 0.7f, 1.0f})
        EXPECT_NEAR(fresnel_conductor(cos_i, 1.7f, 0), fresnel_dielectric(cos_i, 1.7f), 1e-5f);
}

// Fresnel's equations as they are written with complex numbers.
double complex_fresnel(double cos_i, double eta, double k) {
    const std::complex<double> index(eta, k);
    const auto cos_t = std::sqrt(1.0 - (1 - cos_i * cos_i) / (index * index));
    const auto parallel = (index * cos_i - cos_t) / (index * cos_i + cos_t);
    const auto perpendicular = (cos_i - index * cos_t) / (cos_i + index * cos_t);
    return (std::norm(parallel) + std::norm(perpendicular)) / 2;
}

TEST(Fresnel, ConductorAgreesWithComplexNumbers) {
    Rng rng(3);
    for (int i = 0; i < 20000; ++i) {
        const float cos_i = i % 10 == 0 ? 1e-3f * rng.uniform() : rng.uniform();
        auto index = [&] { return std::pow(10.0f, 5 * rng.uniform() - 2); };
        const Spectrum eta(index(), index(), index(), index()), k(index(), index(), index(), index());
        const Spectrum reflected = fresnel_conductor(cos_i, eta, k);
        for (int lane = 0; lane < 4; ++lane)
            ASSERT_NEAR(reflected[lane], complex_fresnel(cos_i, eta[lane], k[lane]), 2e-6)
                << cos_i << ' ' << eta[lane] << ' ' << k[lane];
    }
}

TEST(Fresnel, ConductorsStayBetweenZeroAndOne) {
    const float indices[] = {0, 1e-30f, 1e-6f, 0.5f, 1, 2, 1e6f, 1e30f, infinity};
    for (float cos_i : {0.0f, 1e-20f, 0.3f, 1.0f})
        for (float eta : indices)
            for (float k : indices) {
                const float reflected = fresnel_conductor(cos_i, eta, k);
                EXPECT_TRUE(reflected >= 0 && reflected <= 1) << cos_i << ' ' << eta << ' ' << k;
            }
}

// Every facet's area, seen from above, adds up to the flat surface's.
TEST(Microfacet, ProjectedAreaIsOne) {
    for (TrowbridgeReitz facets : {TrowbridgeReitz(0.3f, 0.3f), TrowbridgeReitz(0.2f, 0.7f)}) {
        double sum = 0;
        constexpr int n = 1000;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                Vec3 w = sample_hemisphere(
                    {(static_cast<float>(i) + 0.5f) / n, (static_cast<float>(j) + 0.5f) / n});
                sum += static_cast<double>(facets.density(w) * w.z);
            }
        EXPECT_NEAR(sum * 6.283185307 / (n * n), 1, 2e-3);
    }
}

// The facets seen from w, projected along w, cover what the flat surface covers (Heitz 2014, equation 16):
// the density of visible normals is one.
TEST(Microfacet, VisibleNormalsHaveUnitMass) {
    TrowbridgeReitz facets(0.25f, 0.6f);
    Vec3 w = normalize(Vec3(0.8f, -0.3f, 0.25f));
    double sum = 0;
    constexpr int n = 1000;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            Vec3 m =
                sample_hemisphere({(static_cast<float>(i) + 0.5f) / n, (static_cast<float>(j) + 0.5f) / n});
            if (dot(m, w) > 0) sum += static_cast<double>(facets.visible_density(w, m));
        }
    EXPECT_NEAR(sum * 6.283185307 / (n * n), 1, 3e-3);
}

TEST(Microfacet, SampledNormalsAreSeen) {
    TrowbridgeReitz facets(0.1f, 0.8f);
    Rng rng(1);
    for (int i = 0; i < 2000; ++i) {
        Vec3 w = sample_hemisphere({rng.uniform(), rng.uniform()});
        if (w.z < 1e-3f) continue;
        Vec3 m = facets.sample(w, {rng.uniform(), rng.uniform()});
        ASSERT_NEAR(length(m), 1, 1e-6f);
        ASSERT_GE(m.z, 0);
        ASSERT_GE(dot(m, w), -1e-4f);
    }
}

TEST(Microfacet, Regularisation) {
    TrowbridgeReitz smooth(0, 0);
    EXPECT_TRUE(smooth.is_smooth());
    smooth.regularize();
    EXPECT_FALSE(smooth.is_smooth());
    // alpha 0.1 at least: density at the top 1 / (pi alpha^2).
    EXPECT_NEAR(smooth.density({0, 0, 1}), inv_pi / 0.01f, 0.1f);
    TrowbridgeReitz rough(0.5f, 0.12f);
    rough.regularize();
    EXPECT_NEAR(rough.density({0, 0, 1}), inv_pi / (0.5f * 0.24f), 1e-3f);
}

} // namespace

} // namespace alhazen
