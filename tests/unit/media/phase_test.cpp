#include "math/phase.h"

#include "math/warp.h"
#include "tests/support/density_test.h"

namespace alhazen {
namespace {

constexpr float anisotropies[] = {-0.95f, -0.5f, -0.0005f, 0, 0.002f, 0.3f, 0.9f};
const Vec3 wo = normalize(Vec3{0.3f, -0.5f, 0.8f});

TEST(Phase, IntegratesToOneAndHasTheMeanCosineG) {
    for (float g : anisotropies) {
        const HenyeyGreenstein phase(g);
        double sum = 0, cosine = 0;
        constexpr int steps = 200000;
        for (int i = 0; i < steps; ++i) {
            const float c = -1 + 2 * (static_cast<float>(i) + 0.5f) / steps;
            // Around the direction of travel.
            const Vec3 wi = Frame::from_z(-wo).to_world({safe_sqrt(1 - c * c), 0, c});
            const double mass = 4 * static_cast<double>(pi) / steps * static_cast<double>(phase.eval(wo, wi));
            sum += mass;
            cosine += mass * static_cast<double>(c);
        }
        EXPECT_NEAR(sum, 1, 2e-3) << g;
        EXPECT_NEAR(cosine, static_cast<double>(g), 2e-3) << g;
    }
}

TEST(Phase, SamplesFollowTheDensity) {
    // Beyond, the cells of the test are wider than the peak.
    for (float g : {-0.7f, -0.5f, -0.0005f, 0.0f, 0.002f, 0.3f, 0.8f}) {
        const HenyeyGreenstein phase(g);
        const Frame around = Frame::from_z(-wo);
        auto sample = [&](Vec2 u) {
            const PhaseSample s = phase.sample(wo, u);
            EXPECT_NEAR(s.pdf / phase.eval(wo, s.wi), 1, 2e-3f) << g;
            EXPECT_NEAR(length(s.wi), 1, 1e-5f);
            const Vec3 local = around.to_local(s.wi);
            const float phi = std::atan2(local.y, local.x);
            return Vec2{phi < 0 ? phi + 2 * pi : phi, local.z};
        };
        auto density = [&](Vec2 p) {
            const float r = safe_sqrt(1 - p.y * p.y);
            return static_cast<double>(
                phase.eval(wo, around.to_world({r * std::cos(p.x), r * std::sin(p.x), p.y})));
        };
        EXPECT_GT(testing_support::chi_square_2d(sample, density, {0, 2 * static_cast<double>(pi), -1, 1},
                                                 100000, 16, 64),
                  testing_support::p_threshold)
            << g;
    }
}

TEST(Phase, NarrowPeaksAreSampledAsWide) {
    for (float g : anisotropies) {
        const HenyeyGreenstein phase(g);
        double cosine = 0;
        constexpr int strata = 4000;
        for (int i = 0; i < strata; ++i)
            cosine -= static_cast<double>(
                          dot(wo, phase.sample(wo, {(static_cast<float>(i) + 0.5f) / strata, 0.3f}).wi)) /
                      strata;
        EXPECT_NEAR(cosine, static_cast<double>(g), 1e-3) << g;
    }
}

TEST(Phase, StaysFiniteAtTheEnds) {
    for (float g : {-1.0f, 1.0f}) {
        const HenyeyGreenstein phase(g);
        EXPECT_TRUE(std::isfinite(phase.eval(wo, -wo)) && std::isfinite(phase.eval(wo, wo)));
        for (float u : {0.0f, 0.5f, 0.99999994f}) {
            const PhaseSample s = phase.sample(wo, {u, u});
            EXPECT_TRUE(is_finite(s.wi) && s.pdf > 0 && std::isfinite(s.pdf));
        }
    }
}

} // namespace
} // namespace alhazen
