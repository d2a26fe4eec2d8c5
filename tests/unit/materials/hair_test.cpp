/// The hair model: energy, colours, and where its lobes point.
#include <gtest/gtest.h>

#include "base/hash.h"
#include "materials/material_set.h"
#include "math/warp.h"
#include "textures/texture_set.h"

namespace alhazen {

namespace {

class HairTest : public ::testing::Test {
  protected:
    const Bsdf& hair(std::vector<Parameter> parameters, float v) {
        Node node;
        node.type = "hair";
        node.parameters = std::move(parameters);
        BuildContext context{messages, ColorMode::rgb};
        textures.build({}, context);
        set.build({node}, context);
        Hit hit;
        hit.uv = {0.5f, v};
        Wavelengths lambda = Wavelengths::rgb();
        return *set.at(0)->at(hit, lambda, arena);
    }
    static std::vector<Parameter> white(float beta_m, float beta_n) {
        return {make_float("sigma_a", 0), make_float("beta_m", beta_m), make_float("beta_n", beta_n)};
    }
    Messages messages;
    TextureSet textures;
    MaterialSet set;
    Arena arena;
};

// By the midpoint rule, without the model's own sampling: the lobes' densities integrate to one.
TEST_F(HairTest, WhiteHairSendsOutAllLight) {
    constexpr int n = 150;
    for (float beta_m : {0.15f, 0.4f, 1.0f})
        for (float beta_n : {0.15f, 0.5f, 1.0f})
            for (float v : {0.02f, 0.4f, 0.9f}) {
                const Bsdf& b = hair(white(beta_m, beta_n), v);
                for (Vec3 wo : {normalize(Vec3(0.2f, 0.5f, 0.8f)), normalize(Vec3(-0.9f, 0.1f, -0.2f))}) {
                    double sum = 0;
                    for (int i = 0; i < n; ++i)
                        for (int j = 0; j < n; ++j) {
                            const Vec2 u{(static_cast<float>(i) + 0.5f) / n,
                                         (static_cast<float>(j) + 0.5f) / n};
                            // The poles lie on the fibre's axis, where the model is even.
                            const Vec3 w = sample_sphere(u);
                            sum += static_cast<double>(b.eval(wo, {w.z, w.x, w.y}).f[0]);
                        }
                    EXPECT_NEAR(sum * 4 * 3.14159265358979 / (n * n), 1, 4e-3)
                        << beta_m << " " << beta_n << " " << v;
                }
            }
}

// Smooth fibres mirror into a cone around themselves, which the scales tilt by twice their angle.
TEST_F(HairTest, SharpHairMirrorsIntoATiltedCone) {
    std::vector<Parameter> sharp{make_float("sigma_a", 1000), make_float("beta_m", 0.02f),
                                 make_float("beta_n", 0.02f), make_float("alpha", 5)};
    const Bsdf& b = hair(sharp, 0.5f);
    const float theta = radians(30);
    const Vec3 wo{std::sin(theta), 0, std::cos(theta)};
    Rng rng(1);
    double sine = 0, y = 0;
    constexpr int n = 200;
    for (int i = 0; i < n; ++i) {
        const float u = rng.uniform(), u1 = rng.uniform();
        auto s = b.sample(wo, u, {u1, rng.uniform()});
        ASSERT_TRUE(s);
        sine += static_cast<double>(s->wi.x / n);
        y += static_cast<double>(s->wi.y / n);
    }
    EXPECT_NEAR(sine, -std::sin(radians(20)), 0.01);
    // Met in the middle, light comes straight back around the fibre.
    EXPECT_NEAR(y, 0, 0.01);
}

TEST_F(HairTest, ColoursComeFromPigmentsReflectanceOrAbsorption) {
    const Vec3 wo = normalize(Vec3(0.3f, 0.4f, 0.8f)), wi = normalize(Vec3(-0.1f, 0.6f, -0.7f));
    auto f = [&](std::vector<Parameter> p) { return hair(std::move(p), 0.4f).eval(wo, wi).f; };
    // Absorption of the two pigments (d'Eon et al. 2011).
    Spectrum brown = f({make_float("eumelanin", 2)});
    EXPECT_EQ(brown, f({make_rgb("sigma_a", 2 * 0.419f, 2 * 0.697f, 2 * 1.37f)}));
    EXPECT_GT(brown[0], brown[1]);
    EXPECT_GT(brown[1], brown[2]);
    EXPECT_EQ(f({make_float("pheomelanin", 1), make_float("eumelanin", 1)}),
              f({make_rgb("sigma_a", 0.419f + 0.187f, 0.697f + 0.4f, 1.37f + 1.05f)}));
    EXPECT_EQ(f({}), f({make_float("eumelanin", 1.3f)}));
    EXPECT_EQ(f({make_rgb("reflectance", 0.2f, 0.5f, 0.8f)}), f({make_rgb("color", 0.2f, 0.5f, 0.8f)}));
    // Of azimuthal roughness 0.3: log(0.5) / 5.9005, squared.
    const float fit =
        5.969f - 0.215f * 0.3f + 2.532f * 0.09f - 10.73f * 0.027f + 5.574f * 0.0081f + 0.245f * 0.00243f;
    const float sigma = std::pow(std::log(0.5f) / fit, 2.0f);
    EXPECT_NEAR(f({make_float("reflectance", 0.5f)})[0], f({make_float("sigma_a", sigma)})[0], 1e-5f);
    EXPECT_EQ(messages.list().size(), 0u);
}

TEST_F(HairTest, WhatIsGivenTwiceIsToldOf) {
    hair({make_float("sigma_a", 0.5f), make_float("eumelanin", 1)}, 0.4f);
    ASSERT_EQ(messages.list().size(), 1u);
    EXPECT_EQ(messages.list()[0].text, "\"eumelanin\" is ignored, since \"sigma_a\" is given too");
    EXPECT_EQ(messages.error_count(), 0u);
}

// Followed from the light, the path has the value of the way back.
TEST_F(HairTest, ImportanceIsTheRadianceOfTheWayBack) {
    const Vec3 wo = normalize(Vec3(0.3f, 0.4f, 0.8f)), wi = normalize(Vec3(-0.6f, 0.2f, -0.7f));
    const Bsdf& b = hair({}, 0.3f);
    const float there = b.eval(wo, wi, TransportMode::importance).f[0] / std::abs(wi.z);
    const float back = b.eval(wi, wo, TransportMode::radiance).f[0] / std::abs(wo.z);
    EXPECT_NEAR(there, back, 1e-6f * back);
    EXPECT_NE(b.eval(wo, wi).f[0] / std::abs(wi.z), back);
}

} // namespace

} // namespace alhazen
