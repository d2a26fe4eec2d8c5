/// Light beneath surfaces: the table of profiles against the formulas it is made of, what is sampled against
/// its density, and energy.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/hash.h"
#include "materials/bssrdf.h"
#include "materials/material_set.h"
#include "math/warp.h"
#include "tests/support/density_test.h"
#include "textures/texture_set.h"

namespace alhazen {

namespace {

using testing_support::chi_square_1d;
using testing_support::chi_square_2d;
using testing_support::p_threshold;

constexpr double two_pi = 6.283185307179586;

const DiffusionTable& water() {
    static const DiffusionTable table(0, 1.33f);
    return table;
}

// What light from below is kept and what light from above gets through belong together: 1 - 2 M(inside) =
// (1 - 2 M(outside)) / eta^2, as both count the same rays.
TEST(BeamDiffusion, FresnelMoments) {
    for (double eta : {1.1, 1.33, 1.5, 2.4}) {
        const double inside = 1 - 2 * fresnel_moment(eta, 1, true);
        const double outside = 1 - 2 * fresnel_moment(eta, 1, false);
        EXPECT_NEAR(inside, outside / (eta * eta), 5e-5) << eta;
    }
    EXPECT_NEAR(fresnel_moment(1, 1, true), 0, 1e-6);
    // Even light on glass: 9.18 % is reflected (Walsh's formula).
    EXPECT_NEAR(2 * fresnel_moment(1.5, 1, false), 0.0918, 1e-4);
    // The fit of d'Eon and Irving (2011), good to three digits.
    auto fit = [](double e) {
        return (-4.61686 + e * (11.1136 + e * (-10.4646 + e * (5.11455 + e * (-1.27198 + e * 0.12746)))));
    };
    for (double eta : {1.2, 1.33, 1.5}) EXPECT_NEAR(fresnel_moment(eta, 1, true), fit(eta), 2e-3);
}

// Without a border and with even scattering, light scattered once comes out in the direction of cosine m at
// half the density over m, weakened on the way in and out: 1/2 int m / (1 + m) dm = (1 - ln 2) / 2.
TEST(BeamDiffusion, SingleScatteringOfAHalfSpace) {
    const ScatteringMatter matter{1, 0, 1};
    double sum = 0;
    constexpr int n = 4000;
    for (int i = 0; i < n; ++i) {
        // Radii by their logarithm.
        const double step = std::log(1e7) / n, r = 1e-5 * std::exp((i + 0.5) * step);
        sum += two_pi * r * r * step * single_scattering(matter, r, 2000);
    }
    EXPECT_NEAR(sum, (1 - std::log(2)) / 2, 1e-3);
}

TEST(BeamDiffusion, TableIsWhatTheFormulasGive) {
    for (float g : {0.0f, 0.7f})
        for (float eta : {1.0f, 1.4f}) {
            const DiffusionTable table(g, eta);
            for (float albedo : {0.21f, 0.6f, 0.93f, 0.9985f})
                for (float r : {0.004f, 0.05f, 0.3f, 1.1f, 4.0f}) {
                    const ScatteringMatter matter{static_cast<double>(albedo), static_cast<double>(g),
                                                  static_cast<double>(eta)};
                    const auto radius = static_cast<double>(r);
                    const double wanted = two_pi * radius *
                                          (single_scattering(matter, radius, 20000) +
                                           multiple_scattering(matter, radius, 20000));
                    EXPECT_NEAR(table.radial(table.row(albedo), r), wanted, 0.01 * wanted)
                        << g << " " << eta << " " << albedo << " " << r;
                }
        }
}

TEST(BeamDiffusion, EffectiveAlbedoIsTheIntegral) {
    for (float albedo : {0.1f, 0.5f, 0.777f, 0.97f, 0.9995f}) {
        const SplineWeights row = water().row(albedo);
        const float end = water().radii().back();
        double sum = 0;
        constexpr int n = 20000;
        for (int i = 0; i < n; ++i) {
            const float x = (static_cast<float>(i) + 0.5f) / n; // squared, for small radii matter
            sum += static_cast<double>(water().radial(row, end * x * x) * 2 * x * end / n);
        }
        EXPECT_NEAR(sum, water().effective_albedo(row), 1e-4 * sum) << albedo;
    }
}

// Their square roots, since densities change most at small radii.
TEST(BeamDiffusion, RadiiFollowTheirDensity) {
    for (float albedo : {0.1f, 0.5f, 0.777f, 0.97f, 0.9995f, 1.0f}) {
        const SplineWeights row = water().row(albedo);
        const float whole = water().effective_albedo(row);
        const auto end = static_cast<double>(std::sqrt(water().sample_radius(row, 0.98f)));
        auto sample = [&](float u) { return std::sqrt(water().sample_radius(row, u)); };
        auto density = [&](float x) {
            return static_cast<double>(water().radial(row, x * x) * 2 * x / whole);
        };
        EXPECT_GT(chi_square_1d(sample, density, 0, end), p_threshold) << albedo;
    }
    // Nothing comes out where nothing is scattered, and no number may break it.
    for (float u : {0.0f, 0.5f, one_minus_epsilon})
        EXPECT_TRUE(std::isfinite(water().sample_radius(water().row(0), u)));
}

TEST(BeamDiffusion, ReflectanceIsInverted) {
    for (float wanted : {0.0f, 0.001f, 0.1f, 0.5f, 0.8f, 0.95f, 0.99f}) {
        const float albedo = water().albedo_for(wanted);
        EXPECT_NEAR(water().effective_albedo(water().row(albedo)), wanted, 1e-4f);
    }
    EXPECT_EQ(water().albedo_for(2), 1);
}

// Where nothing is absorbed nearly all light comes out again, however much it goes straight on at first.
TEST(DiffusionTable, KeepsTheLightOfForwardScattering) {
    for (float g : {0.0f, 0.5f, 0.9f, 0.95f}) {
        const DiffusionTable table(g, 1.3f);
        EXPECT_GT(table.effective_albedo(table.row(1)), 0.93f) << g;
    }
}

TEST(BeamDiffusion, NoMoreLightComesOutThanWentIn) {
    for (float g : {-0.9f, -0.5f, 0.0f, 0.5f, 0.99f})
        for (float eta : {1.0f, 1.33f, 2.5f}) {
            const DiffusionTable table(g, eta);
            for (float albedo = 0; albedo <= 1; albedo += 0.0005f)
                ASSERT_LE(table.effective_albedo(table.row(albedo)), 1 + 1e-3f) << g << " " << eta;
        }
}

TEST(ExitBsdf, AllThatLeavesSumsToOne) {
    for (float eta : {1.0f, 1.33f, 2.0f}) {
        const DiffusionTable table(0, eta);
        const ExitBsdf exit(eta, table.transmittance());
        const Vec3 wo{0, 0, 1};
        double sum = 0;
        constexpr int n = 20000;
        for (int i = 0; i < n; ++i) {
            const Vec3 wi = sample_hemisphere({(static_cast<float>(i) + 0.5f) / n, 0.3f});
            sum += static_cast<double>(exit.eval(wo, wi, TransportMode::radiance).f[0]) * two_pi / n;
        }
        EXPECT_NEAR(sum, 1, 1e-4) << eta;
        const auto s = exit.sample(wo, 0, {0.2f, 0.7f}, TransportMode::radiance);
        ASSERT_TRUE(s);
        EXPECT_EQ(s->f[0], exit.eval(wo, s->wi, TransportMode::radiance).f[0]);
        EXPECT_EQ(s->pdf, exit.eval(wo, s->wi, TransportMode::radiance).pdf);
        EXPECT_EQ(exit.eval(wo, {0, 0, -1}, TransportMode::radiance).pdf, 0);
    }
}

// Probes meet a plane that lies askew beside the point. Its points follow pdf(), per area: of the plane's own
// coordinates, since its axes have unit length.
TEST(Bssrdf, ProbesMeetSurfacesWithTheirDensity) {
    const Spectrum sigma_a(0.5f, 0.2f, 0.1f, 0.05f), sigma_s(1, 2, 2, 3);
    const Bssrdf bssrdf(water(), sigma_a, sigma_s, Wavelengths::rgb());
    const Vec3 middle{0.1f, -0.2f, 0.15f};
    const Frame plane = Frame::from_z(normalize(Vec3(1, 2, 2)));
    constexpr float half = 0.5f;
    Rng axes(7);
    auto meet = [&](Vec2 u) {
        const Vec2 outside{99, 99};
        const auto probe = bssrdf.sample(axes.uniform(), u);
        if (!probe) return outside;
        const Vec3 d = probe->to - probe->from;
        const float t = dot(middle - probe->from, plane.z) / dot(d, plane.z);
        if (!(t >= 0 && t <= 1)) return outside;
        const Vec3 p = plane.to_local(probe->from + d * t - middle);
        return Vec2(p.x, p.y);
    };
    auto density = [&](Vec2 p) {
        return static_cast<double>(bssrdf.pdf(middle + plane.x * p.x + plane.y * p.y, plane.z));
    };
    EXPECT_GT(chi_square_2d(meet, density, {-half, half, -half, half}, 400000, 12, 16), p_threshold);
}

// What is left of a red that does not scatter at all must not end the others.
TEST(Bssrdf, LanesWithoutScatteringAreLeftOut) {
    const Bssrdf some(water(), 0.1f, Spectrum(0, 2, 1, 1), Wavelengths::rgb());
    const Spectrum s = some.eval(0.3f);
    EXPECT_EQ(s[0], 0);
    EXPECT_GT(s[1], 0);
    EXPECT_GT(some.pdf({0.3f, 0, 0}, {0, 0, 1}), 0);
    const Bssrdf none(water(), 0.1f, 0, Wavelengths::rgb());
    EXPECT_FALSE(none.sample(0.5f, {0.5f, 0.5f}));
    EXPECT_EQ(none.pdf({0.3f, 0, 0}, {0, 0, 1}), 0);
    EXPECT_TRUE(none.eval(0.3f).is_black());
}

class SubsurfaceMaterial : public ::testing::Test {
  protected:
    const Material* build(std::vector<Parameter> parameters) {
        Node node;
        node.type = "subsurface";
        node.parameters = std::move(parameters);
        BuildContext context{messages, ColorMode::rgb};
        textures.build({}, context);
        set.build({node}, context);
        return set.at(0);
    }
    std::string fault(std::vector<Parameter> parameters) {
        EXPECT_EQ(build(std::move(parameters)), nullptr);
        return messages.list().empty() ? "" : messages.list().back().text;
    }
    Spectrum value(std::vector<Parameter> parameters, float distance) {
        const Material* m = build(std::move(parameters));
        return m->subsurface(Hit(), Wavelengths::rgb(), arena)->eval(distance);
    }
    Messages messages;
    TextureSet textures;
    MaterialSet set;
    Arena arena;
};

TEST_F(SubsurfaceMaterial, SourcesAgree) {
    const auto milk = value({make_string("name", "Wholemilk")}, 0.2f);
    EXPECT_EQ(value({}, 0.2f), milk);
    EXPECT_EQ(value({make_rgb("sigma_a", 0.0011f, 0.0024f, 0.014f), make_rgb("sigma_s", 2.55f, 3.21f, 3.77f)},
                    0.2f),
              milk);
    // Twice as dense is the same picture at half the size.
    const auto dense = value({make_float("scale", 2)}, 0.1f);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(dense[c], 4 * milk[c], 1e-4f * dense[c]);
    // The reflectance is the effective albedo.
    const float albedo = water().albedo_for(0.6f);
    const auto a = value({make_float("reflectance", 0.6f), make_float("mfp", 0.5f)}, 0.2f);
    const auto b = value({make_float("sigma_a", 2 * (1 - albedo)), make_float("sigma_s", 2 * albedo)}, 0.2f);
    EXPECT_NEAR(a[1], b[1], 1e-4f * b[1]);
    EXPECT_TRUE(messages.list().empty());
}

TEST_F(SubsurfaceMaterial, WhatIsGivenTwiceOrByHalf) {
    EXPECT_EQ(fault({make_string("name", "Wholemilk"), make_float("mfp", 1)}),
              "material \"subsurface\" has both \"name\" and \"mfp\"; it takes one of them");
    EXPECT_EQ(fault({make_float("sigma_a", 1)}),
              "material \"subsurface\" has \"sigma_a\", but not \"sigma_s\"");
    EXPECT_EQ(fault({make_float("sigma_s", 1)}),
              "material \"subsurface\" has \"sigma_s\", but not \"sigma_a\"");
    EXPECT_EQ(fault({make_float("mfp", 1)}), "material \"subsurface\" has \"mfp\", but not \"reflectance\"");
    EXPECT_EQ(fault({make_float("sigma_a", 1), make_float("sigma_s", 1), make_float("reflectance", 0.5f)}),
              "material \"subsurface\" has both \"sigma_a\" and \"reflectance\"; it takes one of them");
    EXPECT_EQ(fault({make_string("name", "Wholemilch")}),
              "no measured matter is named \"Wholemilch\" (did you mean \"Wholemilk\"?)");
}

TEST_F(SubsurfaceMaterial, NamedMatterScattersEvenly) {
    ASSERT_NE(build({make_string("name", "Skin1"), make_float("g", 0.5f)}), nullptr);
    ASSERT_EQ(messages.list().size(), 1u);
    EXPECT_EQ(messages.list()[0].text,
              "\"g\" is ignored, since the coefficients of \"name\" are those of even scattering");
}

} // namespace

} // namespace alhazen
