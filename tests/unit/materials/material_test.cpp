/// Materials as a scene gives them: parameters, colours, mixtures, and messages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "materials/fresnel.h"
#include "materials/material_set.h"
#include "textures/texture_set.h"

namespace alhazen {

namespace {

using ::testing::HasSubstr;

Node node_of(std::string type, std::vector<Parameter> parameters, std::string name = "m") {
    Node node;
    node.type = std::move(type);
    node.name = std::move(name);
    node.parameters = std::move(parameters);
    return node;
}

Parameter strings(std::string name, std::vector<std::string> values) {
    return make_array<std::string>(std::move(name), ValueType::string, std::move(values));
}

Wavelengths wavelengths(float a, float b, float c, float d) {
    return {ColorMode::spectral, Spectrum(a, b, c, d), 1};
}

class MaterialTest : public ::testing::Test {
  protected:
    const Material* build(std::vector<Node> nodes, ColorMode mode = ColorMode::spectral) {
        BuildContext context{messages, mode};
        textures.build({}, context);
        set.build(nodes, context);
        return set.at(0);
    }
    Bsdf* bsdf(std::string type, std::vector<Parameter> parameters,
               Wavelengths lambda = wavelengths(450, 550, 600, 650)) {
        const Material* m = build({node_of(std::move(type), std::move(parameters))}, lambda.mode);
        EXPECT_NE(m, nullptr);
        last_lambda = lambda;
        return m ? m->at(hit(), last_lambda, arena) : nullptr;
    }
    static Hit hit(Vec3 p = {0, 0, 0}) {
        Hit h;
        h.p = p;
        h.ng = h.ns = {0, 0, 1};
        h.dpdu = {1, 0, 0};
        return h;
    }
    std::string first_message() const {
        auto list = messages.list();
        return list.empty() ? "" : list[0].text;
    }

    Messages messages;
    TextureSet textures;
    MaterialSet set;
    Arena arena;
    Wavelengths last_lambda;
};

const Vec3 oblique = normalize(Vec3(0.5f, 0.2f, 0.7f));

TEST_F(MaterialTest, DiffuseIsLambert) {
    Bsdf* b = bsdf("diffuse", {make_float("reflectance", 0.6f)});
    Vec3 wi = normalize(Vec3(-0.3f, 0.4f, 0.5f));
    EXPECT_NEAR(b->eval(oblique, wi).f[0], 0.6f * inv_pi * wi.z, 1e-6f);
    EXPECT_EQ(b->eval(oblique, -wi).f[0], 0);
    EXPECT_NEAR(b->eval(-oblique, -wi).f[0], 0.6f * inv_pi * wi.z, 1e-6f);
    EXPECT_EQ(b->whitted(oblique).ambient[2], 0.6f);
}

TEST_F(MaterialTest, SheetsReflectAndLetThrough) {
    Bsdf* b = bsdf("diffusetransmission", {make_float("reflectance", 0.3f), make_float("transmittance", 0.6f),
                                           make_float("scale", 0.5f)});
    Vec3 wi = normalize(Vec3(-0.3f, 0.4f, 0.5f));
    EXPECT_NEAR(b->eval(oblique, wi).f[0], 0.15f * inv_pi * wi.z, 1e-6f);
    EXPECT_NEAR(b->eval(oblique, -wi).f[0], 0.3f * inv_pi * wi.z, 1e-6f);
    EXPECT_NEAR(b->eval(oblique, -wi).pdf, 2 / 3.0f * inv_pi * wi.z, 1e-6f);
    EXPECT_NEAR(bsdf("diffusetransmission", {})->eval(-oblique, wi).f[0], 0.25f * inv_pi * wi.z, 1e-6f);
}

TEST_F(MaterialTest, CopperIsRedAndBright) {
    // Johnson and Christy 1972: about 0.55 of blue light is reflected, above 0.9 of red.
    Spectrum r = bsdf("conductor", {})->whitted({0, 0, 1}).mirror;
    EXPECT_NEAR(r[0], 0.55f, 0.06f);
    EXPECT_GT(r[3], 0.92f);
    EXPECT_LT(r[1], r[2]);
    Spectrum rgb = bsdf("conductor", {}, Wavelengths::rgb())->whitted({0, 0, 1}).mirror;
    EXPECT_GT(rgb[0], rgb[1]);
    EXPECT_GT(rgb[1], rgb[2]);
    EXPECT_GT(rgb[0], 0.85f);
}

TEST_F(MaterialTest, ConductorReflectanceHoldsAtNormalIncidence) {
    Spectrum r = bsdf("conductor", {make_float("reflectance", 0.37f)})->whitted({0, 0, 1}).mirror;
    EXPECT_NEAR(r[0], 0.37f, 1e-4f);
    build({node_of("conductor", {make_float("reflectance", 0.5f), make_float("k", 3)})});
    EXPECT_THAT(first_message(), HasSubstr("both \"reflectance\" and \"eta\" or \"k\""));
}

TEST_F(MaterialTest, RoughnessIsRemapped) {
    Bsdf* plain = bsdf("conductor", {make_float("roughness", 0.25f)});
    Bsdf* alpha = bsdf("conductor", {make_float("roughness", 0.5f), make_bool("remaproughness", false)});
    EXPECT_NEAR(plain->eval(oblique, {0, 0, 1}).f[0], alpha->eval(oblique, {0, 0, 1}).f[0], 1e-5f);
    Bsdf* u = bsdf("conductor", {make_float("roughness", 0.25f), make_float("uroughness", 0.04f)});
    EXPECT_NE(plain->eval(oblique, {0, 0, 1}).f[0], u->eval(oblique, {0, 0, 1}).f[0]);
}

TEST_F(MaterialTest, GlassSplitsLightAsFresnelSays) {
    Bsdf* b = bsdf("dielectric", {});
    WhittedTerms w = b->whitted(oblique);
    EXPECT_EQ(w.eta, 1.5f);
    EXPECT_FLOAT_EQ(w.mirror[0], fresnel_dielectric(oblique.z, 1.5f));
    EXPECT_FLOAT_EQ(w.mirror[0] + w.refract[0], 1);
    Vec3 beyond = normalize(Vec3(0.9f, 0, -0.4f));
    EXPECT_EQ(b->whitted(beyond).mirror[0], 1);
    EXPECT_EQ(b->whitted(beyond).refract[0], 0);
    EXPECT_FALSE(last_lambda.secondary_terminated());
}

TEST_F(MaterialTest, DispersionKeepsOneWavelength) {
    Bsdf* red = bsdf("dielectric", {make_spectrum("eta", "glass-BK7")}, wavelengths(650, 500, 450, 400));
    EXPECT_TRUE(last_lambda.secondary_terminated());
    float eta_red = red->whitted(oblique).eta;
    float eta_blue = bsdf("dielectric", {make_spectrum("eta", "glass-BK7")}, wavelengths(450, 500, 600, 650))
                         ->whitted(oblique)
                         .eta;
    // Schott: n = 1.5145 at 650 nm, 1.5253 at 450 nm.
    EXPECT_NEAR(eta_red, 1.5145f, 1e-3f);
    EXPECT_NEAR(eta_blue, 1.5253f, 1e-3f);
}

TEST_F(MaterialTest, ThinPaneSumsItsEchoes) {
    // r = 0.04: 2 r / (1 + r).
    EXPECT_NEAR(bsdf("thindielectric", {})->whitted({0, 0, 1}).mirror[0], 0.08f / 1.04f, 1e-6f);
}

TEST_F(MaterialTest, PhongIsTheTextbooks) {
    Bsdf* b = bsdf("phong", {make_float("diffuse", 0.4f), make_float("specular", 0.7f),
                             make_float("shininess", 9), make_float("reflectivity", 0.3f),
                             make_float("transparency", 0.2f), make_float("eta", 1.3f)});
    Vec3 wi = normalize(Vec3(-0.4f, -0.3f, 0.6f));
    Vec3 mirrored{-wi.x, -wi.y, wi.z};
    float expected = 0.4f * wi.z + 0.7f * std::pow(dot(mirrored, oblique), 9.0f);
    EXPECT_NEAR(b->local(oblique, wi)[1], expected, 1e-5f);
    // From below, the normal is turned.
    Vec3 flip{1, 1, -1};
    EXPECT_NEAR(b->local(oblique * flip, wi * flip)[1], expected, 1e-5f);
    EXPECT_EQ(b->local(oblique, -wi)[0], 0);
    EXPECT_EQ(b->local(oblique, normalize(Vec3(-0.5f, -0.2f, -0.01f)))[0], 0);
    WhittedTerms w = b->whitted(oblique);
    EXPECT_EQ(w.ambient[0], 0.4f);
    EXPECT_EQ(w.mirror[0], 0.3f);
    EXPECT_EQ(w.refract[0], 0.2f);
    EXPECT_EQ(w.eta, 1.3f);
    EXPECT_EQ(bsdf("phong", {make_float("ambient", 0.1f)})->whitted(oblique).ambient[0], 0.1f);
}

TEST_F(MaterialTest, PhongAsABsdfIsNormalised) {
    // kd + ks = 0.5 <= 1: nothing is scaled but by 1 - kr.
    Bsdf* b = bsdf("phong", {make_float("diffuse", 0.2f), make_float("specular", 0.3f),
                             make_float("shininess", 7), make_float("reflectivity", 0.4f)});
    Vec3 wi = normalize(Vec3(-0.4f, -0.3f, 0.6f));
    float cos_alpha = dot(Vec3(-wi.x, -wi.y, wi.z), oblique);
    float expected = 0.6f * (0.2f * inv_pi + 0.3f * 9 / (2 * pi) * std::pow(cos_alpha, 7.0f)) * wi.z;
    EXPECT_NEAR(b->eval(oblique, wi).f[0], expected, 1e-5f);
}

TEST_F(MaterialTest, MixShowsEachPartAsOften) {
    const Material* m = build({node_of("mix", {strings("materials", {"a", "b"}), make_float("amount", 0.3f)}),
                               node_of("diffuse", {}, "a"), node_of("interface", {}, "b")});
    ASSERT_NE(m, nullptr);
    int second = 0;
    constexpr int n = 20000;
    for (int i = 0; i < n; ++i) {
        auto x = static_cast<float>(i) * 0.01f;
        const Material* chosen = m->choose(hit({x, 1 - x, 3}));
        EXPECT_EQ(chosen, m->choose(hit({x, 1 - x, 3})));
        second += chosen == set.find("b");
    }
    // Five standard deviations of a binomial: a false alarm in 1.7 million.
    EXPECT_NEAR(second, 0.3 * n, 5 * std::sqrt(0.3 * 0.7 * n));
}

TEST_F(MaterialTest, MixturesNest) {
    const Material* m =
        build({node_of("mix", {strings("materials", {"inner", "c"})}, "outer"),
               node_of("mix", {strings("materials", {"a", "b"})}, "inner"), node_of("diffuse", {}, "a"),
               node_of("conductor", {}, "b"), node_of("dielectric", {}, "c")});
    ASSERT_NE(m, nullptr);
    std::set<const Material*> seen;
    for (int i = 0; i < 200; ++i) seen.insert(m->choose(hit({static_cast<float>(i), 0, 0})));
    EXPECT_EQ(seen, (std::set<const Material*>{set.find("a"), set.find("b"), set.find("c")}));
}

TEST_F(MaterialTest, MixturesKnowTheirShares) {
    const Material* m =
        build({node_of("mix", {strings("materials", {"inner", "c"}), make_float("amount", 0.25f)}, "outer"),
               node_of("mix", {strings("materials", {"a", "b"}), make_float("amount", 0.4f)}, "inner"),
               node_of("diffuse", {}, "a"), node_of("conductor", {}, "b"), node_of("dielectric", {}, "c")});
    ASSERT_NE(m, nullptr);
    EXPECT_TRUE(m->is_mixture());
    std::vector<MaterialShare> shares;
    m->add_shares(hit({1, 2, 3}), 2, shares);
    ASSERT_EQ(shares.size(), 3u);
    const std::pair<const char*, float> expected[] = {{"a", 0.9f}, {"b", 0.6f}, {"c", 0.5f}};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(shares[i].material, set.find(expected[i].first));
        EXPECT_FALSE(shares[i].material->is_mixture());
        EXPECT_NEAR(shares[i].share, expected[i].second, 1e-6f);
    }
}

// Sixty mixtures, each of the next one twice, have 2^60 parts.
TEST_F(MaterialTest, SharesOfDeepMixturesAreFew) {
    std::vector<Node> nodes;
    for (int i = 0; i < 60; ++i)
        nodes.push_back(node_of("mix", {strings("materials", {std::to_string(i + 1), std::to_string(i + 1)})},
                                std::to_string(i)));
    nodes.push_back(node_of("diffuse", {}, "60"));
    const Material* m = build(std::move(nodes));
    ASSERT_NE(m, nullptr);
    std::vector<MaterialShare> shares;
    m->add_shares(hit({1, 2, 3}), 1, shares);
    EXPECT_LE(shares.size(), 128u);
    float sum = 0;
    for (const MaterialShare& s : shares) {
        EXPECT_EQ(s.material, set.find("60"));
        sum += s.share;
    }
    EXPECT_NEAR(sum, 1, 1e-6f);
}

TEST_F(MaterialTest, MixturesOfThemselvesAreErrors) {
    EXPECT_EQ(build({node_of("mix", {strings("materials", {"b", "d"})}, "a"),
                     node_of("mix", {strings("materials", {"a", "d"})}, "b"), node_of("diffuse", {}, "d")}),
              nullptr);
    EXPECT_THAT(first_message(), HasSubstr("the material \"a\" is part of itself through \"b\""));
    EXPECT_EQ(messages.error_count(), 1u);
}

TEST_F(MaterialTest, DeepMixturesAreErrors) {
    std::vector<Node> nodes;
    for (int i = 0; i < 1000; ++i)
        nodes.push_back(node_of("mix", {strings("materials", {std::to_string(i + 1), std::to_string(i + 1)})},
                                std::to_string(i)));
    nodes.push_back(node_of("diffuse", {}, "1000"));
    Messages many;
    BuildContext context{many};
    EXPECT_THROW(
        {
            set.build(nodes, context);
            many.throw_if_errors();
        },
        SceneError);
    EXPECT_THAT(many.list()[0].text, HasSubstr("mixtures are nested deeper than 64"));
}

TEST_F(MaterialTest, UnknownNamesAreErrors) {
    build({node_of("mix", {strings("materials", {"goldd", "gold"})}), node_of("conductor", {}, "gold")});
    EXPECT_THAT(first_message(), HasSubstr("\"goldd\", which is not defined (did you mean \"gold\"?)"));
}

TEST_F(MaterialTest, MixNeedsTwo) {
    build({node_of("mix", {strings("materials", {"gold"})}), node_of("conductor", {}, "gold")});
    EXPECT_THAT(first_message(), HasSubstr("must have two names of materials"));
}

TEST_F(MaterialTest, DuplicateNamesAreErrors) {
    build({node_of("diffuse", {}, "x"), node_of("conductor", {}, "x")});
    EXPECT_THAT(first_message(), HasSubstr("the material \"x\" is already defined"));
}

TEST_F(MaterialTest, UnknownKindIsAnErrorOrGrey) {
    EXPECT_EQ(build({node_of("difuse", {})}), nullptr);
    EXPECT_THAT(first_message(), HasSubstr("unknown material \"difuse\" (did you mean \"diffuse\"?)"));
    Messages lenient;
    lenient.lenient = true;
    BuildContext context{lenient};
    set.build({node_of("velvet", {make_float("beta_m", 0.3f)})}, context);
    EXPECT_NE(set.at(0), nullptr);
    EXPECT_EQ(lenient.error_count(), 0u);
    EXPECT_THAT(lenient.warnings().at(0).text, HasSubstr("using \"diffuse\""));
}

TEST_F(MaterialTest, LenientKeepsTheParametersOfUnknownKinds) {
    messages.lenient = true;
    build({node_of("velvet", {make_rgb("reflectance", 0.8f, 0.1f, 0.1f), make_float("beta_m", 0.1f)})},
          ColorMode::rgb);
    ASSERT_NE(set.find("m"), nullptr);
    EXPECT_EQ(messages.error_count(), 0u);
    EXPECT_THAT(first_message(), HasSubstr("; using \"diffuse\" instead, without \"beta_m\""));
    Wavelengths lambda = Wavelengths::rgb();
    Spectrum ambient = set.find("m")->at(hit(), lambda, arena)->whitted(oblique).ambient;
    EXPECT_NEAR(ambient[0], 0.8f, 1e-6f);
    EXPECT_NEAR(ambient[2], 0.1f, 1e-6f);
}

TEST_F(MaterialTest, LenientTakesTheNearestKind) {
    messages.lenient = true;
    build({node_of("metal", {}, "a"), node_of("glass", {make_float("eta", 2)}, "b")});
    ASSERT_EQ(messages.list().size(), 2u);
    EXPECT_THAT(messages.list()[0].text, HasSubstr("; using \"conductor\" instead"));
    EXPECT_THAT(messages.list()[1].text, ::testing::EndsWith("; using \"dielectric\" instead"));
}

TEST_F(MaterialTest, RemembersTheNamesOfWrongMaterials) {
    build({node_of("difuse", {}, "a")});
    EXPECT_EQ(set.find("a"), nullptr);
    EXPECT_TRUE(set.has("a"));
    EXPECT_FALSE(set.has("b"));
}

TEST_F(MaterialTest, ReflectanceAboveOneIsAnError) {
    build({node_of("diffuse", {make_rgb("reflectance", 0.5f, 1.5f, 0)})});
    EXPECT_THAT(first_message(), HasSubstr("\"reflectance\" is 1.5 (its 2nd value); it must be 0 to 1"));
}

TEST_F(MaterialTest, InterfaceHasNoBsdf) {
    const Material* m = build({node_of("interface", {})});
    EXPECT_TRUE(m->is_interface());
    Wavelengths lambda;
    EXPECT_EQ(m->at(hit(), lambda, arena), nullptr);
}

} // namespace

} // namespace alhazen
