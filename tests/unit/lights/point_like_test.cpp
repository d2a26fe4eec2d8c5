#include "tests/support/light_probe.h"

namespace alhazen {
namespace {

Vec3 color_at(const Light& light, const LightReceiver& at, ColorMode mode) {
    return film_color(mode,
                      [&](const Wavelengths& lambda) { return sampled_irradiance(light, at, lambda, 1); });
}

TEST(PointLight, IrradianceFallsWithSquareAndCosine) {
    // E = I cos / d^2 with d = 2, cos = 0.6: 0.15 I.
    for (ColorMode mode : both_modes) {
        auto light = make_light("point", {make_rgb("I", 4, 2, 1), make_point3("from", {1, 2, 3})}, {mode});
        LightReceiver at{{1, 2, 1}, {0.8f, 0, 0.6f}};
        expect_color(color_at(*light, at, mode), Vec3(4, 2, 1) * 0.15f, 2e-3f);
        auto s = light->sample(at, {0.3f, 0.7f}, Wavelengths::rgb());
        ASSERT_TRUE(s);
        EXPECT_EQ(s->pdf, 1);
        EXPECT_EQ(s->p, Vec3(1, 2, 3));
        EXPECT_EQ(s->ng, Vec3());
        EXPECT_TRUE(light->is_delta());
    }
}

TEST(PointLight, UnfadingLightGivesItsIntensityAnywhere) {
    auto light = make_light("point", {make_rgb("I", .9f, .8f, .7f), make_string("falloff", "none")});
    for (float d : {0.01f, 1.0f, 1000.0f}) {
        auto s = light->sample({{0, d, 0}, {0, -1, 0}}, {0, 0}, Wavelengths::rgb());
        ASSERT_TRUE(s);
        EXPECT_FLOAT_EQ(s->L[0], .9f);
        EXPECT_FLOAT_EQ(s->L[1], .8f);
        EXPECT_FLOAT_EQ(s->L[2], .7f);
    }
}

TEST(PointLight, ScaleAndPowerAreFactorsOnANormalisedSpectrum) {
    // A spectrum shows with luminance 1 whatever its size; power = 4 pi I; scale multiplies.
    for (ColorMode mode : both_modes) {
        auto plain = make_light("point", {make_array<float>("I", ValueType::blackbody, {3000})}, {mode});
        Vec3 c = color_at(*plain, {{0, 0, -1}, {0, 0, 1}}, mode);
        EXPECT_NEAR(0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z, 1, 3e-3f);
        auto lamp = make_light("point", {make_float("power", 8 * pi), make_float("scale", 3)}, {mode});
        expect_color(color_at(*lamp, {{0, 0, -1}, {0, 0, 1}}, mode), Vec3(6), 3e-3f);
        // As in pbrt-v4, a power that is not positive is none.
        auto none = make_light("point", {make_float("power", -1)}, {mode});
        expect_color(color_at(*none, {{0, 0, -1}, {0, 0, 1}}, mode), Vec3(1), 3e-3f);
    }
}

TEST(PointLight, StandsWhereItsTransformationPutsIt) {
    Matrix4 world = Matrix4::translate({5, 0, 0}) * Matrix4::scale({2, 2, 2});
    auto light = make_light("point", {make_point3("from", {0, 1, 0})}, {ColorMode::rgb, world});
    EXPECT_EQ(light->bounds()->bounds.lo, Vec3(5, 2, 0));
    EXPECT_EQ(light->bounds()->bounds.hi, Vec3(5, 2, 0));
}

TEST(PointLight, NothingArrivesAtTheLightItselfOrFromBlack) {
    auto light = make_light("point", {});
    EXPECT_FALSE(light->sample({{0, 0, 0}, {0, 0, 1}}, {0, 0}, Wavelengths::rgb()));
    auto black = make_light("point", {make_rgb("I", 0, 0, 0)});
    EXPECT_FALSE(black->sample({{0, 0, 1}, {0, 0, 1}}, {0, 0}, Wavelengths::rgb()));
    EXPECT_EQ(black->bounds()->power, 0);
}

TEST(SpotLight, IsFullWithinAndDarkBeyondTheCone) {
    auto light = make_light("spot", {make_rgb("I", 8, 8, 8), make_point3("from", {0, 0, 2}),
                                     make_point3("to", {0, 0, 0}), make_float("coneangle", 40),
                                     make_float("conedeltaangle", 20)});
    auto at_angle = [&](float angle) {
        float a = radians(angle);
        Vec3 p = Vec3(0, 0, 2) + Vec3(std::sin(a), 0, -std::cos(a)) * 2.0f;
        auto s = light->sample({p, {}}, {0, 0}, Wavelengths::rgb());
        return s ? s->L[0] : 0.0f;
    };
    EXPECT_NEAR(at_angle(0), 2, 1e-5f);
    EXPECT_NEAR(at_angle(19.9f), 2, 1e-5f);
    EXPECT_EQ(at_angle(40.1f), 0);
    EXPECT_EQ(at_angle(180), 0);
    // The middle of the rim, in cosine: half of the light.
    float middle = degrees(std::acos((std::cos(radians(40.0f)) + std::cos(radians(20.0f))) / 2));
    EXPECT_NEAR(at_angle(middle), 1, 1e-3f);
}

TEST(SpotLight, PowerIsTheIntegralOverItsCone) {
    for (auto [cone, delta] : {std::pair{30.0f, 5.0f}, {90.0f, 60.0f}, {180.0f, 180.0f}, {20.0f, 0.0f}}) {
        auto light = make_light("spot", {make_float("coneangle", cone), make_float("conedeltaangle", delta),
                                         make_float("power", 100)});
        EXPECT_NEAR(light->power(Wavelengths::rgb())[1], 100, 0.01);
        EXPECT_NEAR(flux_through_sphere(*light, {0, 0, 0}, 1, Wavelengths::rgb(), 400, 1), 100, 1.0);
    }
}

TEST(SpotLight, BoundsHoldTheConeWhateverTheTransformation) {
    Matrix4 turned =
        Matrix4::translate({1, 2, 3}) * Matrix4::rotate(70, {1, 1, 0}) * Matrix4::scale({-2, 2, 2});
    auto light = make_light("spot", {make_float("coneangle", 30)}, {ColorMode::rgb, turned});
    LightBounds b = *light->bounds();
    float widest = std::acos(b.cos_normals) + std::acos(b.cos_falloff);
    EXPECT_NEAR(degrees(widest), 30, 0.5f);
    Rng rng(3);
    for (int i = 0; i < 10000; ++i) {
        Vec3 d = sample_sphere({rng.uniform(), rng.uniform()});
        if (!light->sample({Vec3(1, 2, 3) + d, {}}, {0, 0}, Wavelengths::rgb())) continue;
        EXPECT_LE(std::acos(std::clamp(dot(d, b.axis), -1.0f, 1.0f)), widest);
    }
    // A stretched cone is no cone any more: any direction is then possible.
    auto stretched = make_light("spot", {}, {ColorMode::rgb, Matrix4::scale({5, 1, 1})});
    EXPECT_EQ(stretched->bounds()->cos_normals, -1);
}

TEST(DistantLight, IrradianceIsItsValueTimesTheCosine) {
    for (ColorMode mode : both_modes) {
        auto light = make_light(
            "distant", {make_rgb("L", 1, 2, 3), make_point3("from", {0, 3, 4}), make_point3("to", {0, 0, 0})},
            {mode});
        light->prepare({{-1, -1, -1}, {1, 1, 1}});
        LightReceiver at{{0.5f, 0, 0}, {0, 0, 1}};
        expect_color(color_at(*light, at, mode), Vec3(1, 2, 3) * 0.8f, 2e-3f);
        auto s = light->sample(at, {0, 0}, Wavelengths::rgb());
        EXPECT_GT(length(s->p - at.p), 2 * std::sqrt(3.0f)); // beyond the scene's other side
        EXPECT_FALSE(light->bounds());
        EXPECT_FALSE(light->is_infinite()); // rays that leave the scene do not see it
        // Through a disk as large as the scene's sphere: 3 pi.
        expect_color(film_color(mode, [&](const Wavelengths& l) { return light->power(l); }),
                     Vec3(1, 2, 3) * (3 * pi), 2e-3f);
        auto measured = make_light("distant", {make_float("illuminance", 7), make_float("scale", 2)}, {mode});
        expect_color(color_at(*measured, {{0, 0, 0}, {0, 0, -1}}, mode), Vec3(14), 3e-3f);
    }
}

TEST(PointLikeLights, SayWhatIsWrong) {
    Node spot = make_node("spot", {make_point3("from", {1, 1, 1}), make_point3("to", {1, 1, 1})});
    EXPECT_EQ(build_error(light_kinds(), spot),
              "light \"spot\" has the same point for \"from\" and \"to\"; it needs a direction");
    Node distant = make_node("distant", {make_point3("from", {0, 0, 1})});
    EXPECT_EQ(build_error(light_kinds(), distant),
              "light \"distant\" has the same point for \"from\" and \"to\"; it needs a direction");
    EXPECT_NE(build_error(light_kinds(), make_node("point", {make_string("falloff", "linear")}))
                  .find("inverse-square"),
              std::string::npos);
    EXPECT_NE(build_error(light_kinds(), make_node("point", {make_float("scale", -1)})).find("at least 0"),
              std::string::npos);
    EXPECT_NE(build_error(light_kinds(), make_node("pont", {})).find("did you mean \"point\""),
              std::string::npos);
    EXPECT_NE(build_error(light_kinds(), make_node("spot", {make_float("coneangel", 3)})).find("coneangle"),
              std::string::npos);
}

} // namespace
} // namespace alhazen
