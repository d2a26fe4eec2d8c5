/// Coated surfaces against closed forms, and the coat's tables against random walks.
#include <gtest/gtest.h>

#include "materials/coat.h"
#include "materials/layered.h"
#include "materials/material_set.h"
#include "tests/support/statistics.h"
#include "textures/texture_set.h"

namespace alhazen {

namespace {

Vec3 direction(float cosine, float azimuth) {
    float sine = safe_sqrt(1 - sqr(cosine));
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

float fresnel(float cosine) {
    return fresnel_dielectric(cosine, 1.5f);
}
float cosine_below(float cosine) {
    return std::sqrt(1 - (1 - sqr(cosine)) / sqr(1.5f));
}

class CoatedTest : public ::testing::Test {
  protected:
    const Bsdf& coated(const std::string& type, std::vector<Parameter> parameters, Vec3 p = {},
                       Vec2 uv = {}) {
        Node node;
        node.type = type;
        node.name = "m";
        node.parameters = std::move(parameters);
        BuildContext context{messages, ColorMode::rgb};
        textures.build({}, context);
        auto set = std::make_unique<MaterialSet>();
        set->build({node}, context);
        sets.push_back(std::move(set));
        const Material* m = sets.back()->at(0);
        if (!m) throw std::runtime_error(messages.list().at(0).text);
        Hit hit;
        hit.p = p;
        hit.uv = uv;
        hit.ng = hit.ns = {0, 0, 1};
        hit.dpdu = {1, 0, 0};
        Wavelengths lambda = Wavelengths::rgb();
        return *m->at(hit, lambda, arena);
    }
    Messages messages;
    TextureSet textures;
    std::vector<std::unique_ptr<MaterialSet>> sets;
    Arena arena;
};

/// Mean of the walks' estimates, from many places.
testing::Moments walk_mean(const DielectricBsdf& border, Spectrum reflectance, const Layer& layer, Vec3 wo,
                           Vec3 wi, int walks) {
    std::vector<double> values;
    for (int i = 0; i < walks; ++i) {
        LayeredBsdf<DiffuseBsdf> bsdf(border, DiffuseBsdf(reflectance), layer, hash_of(i));
        values.push_back(static_cast<double>(bsdf.eval(wo, wi, TransportMode::radiance).f[0]));
    }
    return testing::moments(values);
}

// One reflection at the base: in, down, off, up, out. The others bring reflectance times what the border
// sends back.
TEST_F(CoatedTest, SmoothCoatOverMatteBaseIsItsSeries) {
    const Vec3 wo = direction(0.8f, 0.3f), wi = direction(0.4f, 2);
    auto f = [&](int maxdepth) {
        return coated("coateddiffuse", {make_float("reflectance", 0.6f), make_float("thickness", 0.1f),
                                        make_integer("maxdepth", maxdepth)})
            .eval(wo, wi)
            .f[0];
    };
    auto in = [](float c) { return (1 - fresnel(c)) * std::exp(-0.1f / cosine_below(c)); };
    const float once = 0.6f * inv_pi / 2.25f * in(0.8f) * in(0.4f) * 0.4f;
    EXPECT_NEAR(f(2), once, 1e-6f);
    EXPECT_NEAR(f(1), once, 1e-6f);
    EXPECT_EQ(f(0), 0);
    const float ratio = f(4) / f(2) - 1; // of one reflection to the next
    EXPECT_NEAR(f(6) / f(2), 1 + ratio + ratio * ratio, 1e-5f);
    // Without absorption a smooth border of index 1.5 sends back 0.596 of matte light from within (Judd
    // 1942).
    const float thin =
        coated("coateddiffuse",
               {make_float("reflectance", 1), make_float("thickness", 0), make_integer("maxdepth", 4)})
            .eval(wo, wi)
            .f[0] /
        coated("coateddiffuse",
               {make_float("reflectance", 1), make_float("thickness", 0), make_integer("maxdepth", 2)})
            .eval(wo, wi)
            .f[0];
    EXPECT_NEAR(thin - 1, 0.596f, 2e-3f);
}

// Everything comes back in the end.
TEST_F(CoatedTest, WhiteBaseUnderClearCoatLosesNothing) {
    const Bsdf& b = coated("coateddiffuse", {make_float("reflectance", 1), make_float("thickness", 0),
                                             make_integer("maxdepth", 200)});
    for (float cosine : {1.0f, 0.5f, 0.1f}) {
        double sum = 0;
        constexpr int n = 20000;
        for (int i = 0; i < n; ++i) {
            float u = (static_cast<float>(i) + 0.5f) / n;
            const Vec3 wi = direction(std::sqrt(u), 0);
            sum += static_cast<double>(b.eval(direction(cosine, 1), wi).f[0] * pi / wi.z) / n;
        }
        EXPECT_NEAR(sum + static_cast<double>(fresnel(cosine)), 1, 1e-3) << cosine;
    }
}

// The tables' mean is the walks' mean, smooth and rough, thin and thick. Five standard errors, and a
// thousandth for the tables.
TEST_F(CoatedTest, CoatAgreesWithRandomWalks) {
    for (float alpha : {0.0f, 0.05f, 0.3f, 0.9f})
        for (float thickness : {0.01f, 0.7f})
            for (float eta : {1.2f, 1.5f}) {
                const DielectricBsdf border({alpha, alpha}, eta);
                Layer layer;
                layer.thickness = thickness;
                for (float cosine : {0.9f, 0.3f}) {
                    const Vec3 wo = direction(cosine, 0), wi = direction(0.6f, 1.9f);
                    const Bsdf& b = coated(
                        "coateddiffuse", {make_float("reflectance", 0.8f), make_float("thickness", thickness),
                                          make_float("eta", eta), make_float("roughness", alpha),
                                          make_bool("remaproughness", false)});
                    ASSERT_FALSE(b.is_stochastic());
                    auto walks = walk_mean(border, 0.8f, layer, wo, wi, 20000);
                    EXPECT_NEAR(static_cast<double>(b.eval(wo, wi).f[0]), walks.mean,
                                5 * std::sqrt(walks.variance_of_mean) + 2e-3 * walks.mean)
                        << "alpha " << alpha << " thickness " << thickness << " eta " << eta << " cos "
                        << cosine;
                }
            }
}

// Where roughness varies, rows of the table are mixed.
TEST_F(CoatedTest, CoatOfAnyRoughnessIsNearThoseOfOne) {
    const Coat any(1.5f, 0.01f, std::nullopt);
    for (float alpha : {0.0f, 0.003f, 0.08f, 0.33f, 0.71f, 1.0f}) {
        const Coat one(1.5f, 0.01f, alpha);
        Coat::Place a = any.at(alpha), b = one.at(alpha);
        EXPECT_NEAR(a.sent_back, b.sent_back, 3e-3f) << alpha;
        EXPECT_NEAR(a.let_out, b.let_out, 3e-3f) << alpha;
        for (float cosine : {1.0f, 0.7f, 0.3f, 0.1f, 0.03f})
            EXPECT_NEAR(a.let_in(cosine), b.let_in(cosine), 6e-3f) << alpha << " " << cosine;
    }
}

// Mirror over mirror: R + T^2 B (1 + B R + ...).
TEST_F(CoatedTest, SmoothCoatOverMirrorIsASpecularSeries) {
    const Bsdf& b = coated("coatedconductor", {make_float("reflectance", 0.7f), make_float("thickness", 0.2f),
                                               make_integer("maxdepth", 6)});
    EXPECT_FALSE(b.is_stochastic());
    EXPECT_FALSE(has(b.lobes(), Lobes::glossy | Lobes::diffuse));
    auto s = b.sample({0, 0, 1}, 0.5f, {0.5f, 0.5f});
    ASSERT_TRUE(s);
    EXPECT_TRUE(has(s->lobes, Lobes::specular));
    // The parameter is the reflectance in air; in the coat, k is smaller by its index.
    const float k = 2 * std::sqrt(0.7f) / std::sqrt(0.3f);
    const float base = fresnel_conductor(1, 1 / 1.5f, k / 1.5f) * std::exp(-0.4f), r = 0.04f;
    EXPECT_NEAR(s->f[0] / s->pdf, r + sqr(1 - r) * base * (1 + base * r + sqr(base * r)), 1e-5f);
    // From below the same.
    auto below = b.sample({0, 0, -1}, 0.5f, {0.5f, 0.5f});
    ASSERT_TRUE(below);
    EXPECT_EQ(below->wi.z, -1);
    EXPECT_EQ(below->f[0], s->f[0]);
}

// A smooth coat bends what goes to a rough metal and back; that one reflection comes without chance.
TEST_F(CoatedTest, FirstReflectionUnderASmoothCoatIsExact) {
    const Bsdf& b =
        coated("coatedconductor", {make_float("reflectance", 0.7f), make_float("thickness", 0.2f),
                                   make_float("conductor.roughness", 0.2f), make_integer("maxdepth", 1)});
    EXPECT_TRUE(b.is_stochastic());
    const Vec3 wo = direction(0.9f, 0), wi = direction(0.6f, 2.5f);
    const float k = 2 * std::sqrt(0.7f) / std::sqrt(0.3f), alpha = std::sqrt(0.2f);
    const ConductorBsdf metal({alpha, alpha}, 1 / 1.5f, k / 1.5f);
    const Vec3 o = direction(cosine_below(0.9f), 0), i = direction(cosine_below(0.6f), 2.5f);
    const float passed = (1 - fresnel(0.9f)) * (1 - fresnel(0.6f)) * std::exp(-0.2f / o.z - 0.2f / i.z);
    const float expected = passed / 2.25f * metal.eval(o, i, TransportMode::radiance).f[0] / i.z * 0.6f;
    EXPECT_NEAR(b.eval(wo, wi).f[0], expected, 1e-5f * expected);
}

// The same directions at the same place give the same number; elsewhere another.
TEST_F(CoatedTest, ChanceBelongsToThePlace) {
    std::vector<Parameter> milky{make_float("albedo", 0.9f), make_float("thickness", 1)};
    const Vec3 wo = direction(0.9f, 0), wi = direction(0.6f, 2.5f);
    const float f = coated("coateddiffuse", milky, {1, 2, 3}).eval(wo, wi).f[0];
    EXPECT_EQ(coated("coateddiffuse", milky, {1, 2, 3}).eval(wo, wi).f[0], f);
    EXPECT_NE(coated("coateddiffuse", milky, {1, 2, 3.01f}).eval(wo, wi).f[0], f);
}

TEST_F(CoatedTest, AskingForTwoColoursIsAnError) {
    EXPECT_THROW(coated("coatedconductor", {make_float("reflectance", 0.7f), make_float("conductor.k", 2)}),
                 std::runtime_error);
    EXPECT_EQ(messages.list().at(0).text, "material \"coatedconductor\" has both \"reflectance\" and "
                                          "\"conductor.eta\" or \"conductor.k\"; only one can be given");
}

} // namespace

} // namespace alhazen
