#include "image/codec.h"
#include "tests/support/light_probe.h"
#include "tests/unit/lights/test_shapes.h"

namespace alhazen {
namespace {

// Irradiance of a horizontal receiver from a polygon of radiance 1 above its horizon (Lambert 1760): half the
// sum over edges of the angle the edge subtends times the cosine between n and the normal of the edge's
// plane.
float polygon_irradiance(Vec3 p, Vec3 n, const std::vector<Vec3>& corners) {
    float sum = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        Vec3 a = normalize(corners[i] - p), b = normalize(corners[(i + 1) % corners.size()] - p);
        sum += std::acos(dot(a, b)) * dot(normalize(cross(a, b)), n);
    }
    return std::abs(sum) / 2;
}

Hit hit_on(const ShapeSample& s, Vec3 towards) {
    Hit hit;
    hit.p = s.p;
    hit.ng = hit.ns = s.ng;
    hit.uv = s.uv;
    hit.wo = normalize(towards - s.p);
    return hit;
}

TEST(DiffuseAreaLight, TriangleLightsAsLambertFound) {
    TestTriangle shape({-1, -1, 2}, {-1, 1, 2.5f}, {1, 0, 1.5f}); // faces down
    ASSERT_LT(shape.normal().z, 0);
    for (ColorMode mode : both_modes) {
        auto light = make_area_light({make_rgb("L", 3, 2, 1)}, {mode})->attach(shape, 0);
        LightReceiver at{{0.3f, 0.2f, 0}, {0, 0, 1}};
        Vec3 e =
            film_color(mode, [&](const Wavelengths& l) { return sampled_irradiance(*light, at, l, 50); });
        float expected = polygon_irradiance(at.p, at.ns, {shape.a, shape.b, shape.c});
        expect_color(e, Vec3(3, 2, 1) * expected, 5e-3f);
    }
}

TEST(DiffuseAreaLight, SphereLightsAsADiskOfItsWidth) {
    // E = pi L (r / d)^2 cos, the sphere being wholly above the horizon.
    TestSphere shape({0, 0, 3}, 1);
    auto light = make_area_light({make_rgb("L", 2, 2, 2)})->attach(shape, 0);
    Spectrum e = sampled_irradiance(*light, {{0, 0, 0}, {0.6f, 0, 0.8f}}, Wavelengths::rgb(), 700);
    EXPECT_NEAR(e[0], 2 * pi / 9 * 0.8f, 5e-3f);
}

TEST(DiffuseAreaLight, GlowsOnTheSideOfItsNormalsOnly) {
    TestSquare shape;
    auto one = make_area_light({make_rgb("L", 2, 2, 2)})->attach(shape, 0);
    auto two = make_area_light({make_rgb("L", 2, 2, 2), make_bool("twosided", true)})->attach(shape, 0);
    ShapeSample point = shape.sample(0, {0.25f, 0.5f});
    Wavelengths lambda = Wavelengths::rgb();
    LightReceiver above{{0, 0, 1}, {}}, below{{0, 0, -1}, {}};
    EXPECT_EQ(one->emitted(hit_on(point, above.p), lambda)[0], 2);
    EXPECT_EQ(one->emitted(hit_on(point, below.p), lambda)[0], 0);
    EXPECT_EQ(two->emitted(hit_on(point, above.p), lambda)[0], 2);
    EXPECT_EQ(two->emitted(hit_on(point, below.p), lambda)[0], 2);
    EXPECT_TRUE(one->sample(above, {0.25f, 0.5f}, lambda));
    EXPECT_FALSE(one->sample(below, {0.25f, 0.5f}, lambda));
    EXPECT_TRUE(two->sample(below, {0.25f, 0.5f}, lambda));
    EXPECT_FALSE(one->bounds()->two_sided);
    EXPECT_TRUE(two->bounds()->two_sided);
}

TEST(DiffuseAreaLight, SampleAndHitHaveTheSameDensity) {
    TestTriangle shape({-1, -1, 2}, {-1, 1, 2.5f}, {1, 0, 1.5f});
    auto light = make_area_light({})->attach(shape, 0);
    LightReceiver at{{0.3f, 0.2f, 0}, {0, 0, 1}};
    Rng rng(2);
    for (int i = 0; i < 100; ++i) {
        Vec2 u{rng.uniform(), rng.uniform()};
        auto s = light->sample(at, u, Wavelengths::rgb());
        ASSERT_TRUE(s);
        Hit hit = hit_on(shape.sample(0, u), at.p);
        EXPECT_NEAR(light->pdf_hit(at, hit, s->wi), s->pdf, 1e-4f * s->pdf);
        EXPECT_EQ(light->emitted(hit, Wavelengths::rgb()), s->L);
        EXPECT_TRUE(light->bounds()->bounds.contains(s->p));
    }
}

TEST(DiffuseAreaLight, PowerIsTheFluxThatLeaves) {
    TestTriangle triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0.5f});
    TestSphere sphere({0, 0, 0}, 0.5f);
    for (bool two_sided : {false, true})
        for (const Shape* shape :
             {static_cast<const Shape*>(&triangle), static_cast<const Shape*>(&sphere)}) {
            auto light = make_area_light({make_bool("twosided", two_sided), make_rgb("L", 1, 1, 1)})
                             ->attach(*shape, 0);
            float expected = pi * shape->area(0) * (two_sided ? 2.0f : 1.0f);
            EXPECT_FLOAT_EQ(light->power(Wavelengths::rgb())[0], expected);
            // From inside a closed surface nothing gets out; for the sphere the second side stays within.
            if (shape == &sphere && two_sided) continue;
            EXPECT_NEAR(flux_through_sphere(*light, {0, 0, 0}, 4, Wavelengths::rgb(), 60, 8) /
                            static_cast<double>(expected),
                        1, 0.01);
        }
}

TEST(DiffuseAreaLight, PowerParameterHoldsForEachPrimitive) {
    TestTriangle shape({0, 0, 0}, {2, 0, 0}, {0, 3, 0});
    for (ColorMode mode : both_modes)
        for (bool two_sided : {false, true}) {
            auto light = make_area_light({make_float("power", 50), make_float("scale", 2),
                                          make_bool("twosided", two_sided)},
                                         {mode})
                             ->attach(shape, 0);
            expect_color(film_color(mode, [&](const Wavelengths& l) { return light->power(l); }), Vec3(100),
                         2e-3f);
        }
}

TEST(DiffuseAreaLight, InvisibleShapesLightAsDeltaLightsDo) {
    TestSquare shape;
    auto plain = make_area_light({})->attach(shape, 0);
    LightReceiver at{{0.2f, 0.3f, 1}, {0, 0, -1}};
    auto t = plain->sample(at, {0.1f, 0.9f}, Wavelengths::rgb());
    shape.alpha = FloatTexture(0.0f);
    auto light = make_area_light({})->attach(shape, 0);
    EXPECT_TRUE(light->is_delta());
    EXPECT_FALSE(plain->is_delta());
    auto s = light->sample(at, {0.1f, 0.9f}, Wavelengths::rgb());
    ASSERT_TRUE(s && t);
    EXPECT_EQ(s->pdf, 1);
    EXPECT_FLOAT_EQ(s->L[0], t->L[0] / t->pdf);
    EXPECT_EQ(light->pdf_hit(at, hit_on(shape.sample(0, {0.1f, 0.9f}), at.p), s->wi), 0);
}

TEST(DiffuseAreaLight, HalfTransparentShapesGiveHalfTheLight) {
    TestSquare shape;
    auto solid = make_area_light({})->attach(shape, 0);
    LightReceiver at{{0.2f, 0.3f, 1}, {0, 0, -1}};
    float whole = solid->sample(at, {0.1f, 0.9f}, Wavelengths::rgb())->L[0];
    shape.alpha = FloatTexture(0.25f);
    auto light = make_area_light({})->attach(shape, 0);
    EXPECT_FLOAT_EQ(light->sample(at, {0.1f, 0.9f}, Wavelengths::rgb())->L[0], whole / 4);
}

TEST(DiffuseAreaLight, ShowsAnImageUpright) {
    auto folder = std::filesystem::temp_directory_path() / "alhazen_lights_screen";
    std::filesystem::create_directories(folder);
    Image image = Image::rgb_image(2, 2);
    image.set_rgb(0, 0, {1, 0, 0}); // upper left: u small, v large
    image.set_rgb(1, 0, {0, 1, 0});
    image.set_rgb(0, 1, {0, 0, 1});
    image.set_rgb(1, 1, {4, 4, 4});
    write_image(folder / "screen.pfm", image);
    TestSquare shape;
    for (ColorMode mode : both_modes) {
        LightSetting setting{mode, {}, folder};
        auto light = make_area_light({make_string("filename", "screen.pfm"), make_float("scale", 2)}, setting)
                         ->attach(shape, 0);
        auto seen = [&](Vec2 uv) {
            Hit hit = hit_on(shape.sample(0, uv), {0.5f, 0.5f, 1});
            return film_color(mode, [&](const Wavelengths& l) { return light->emitted(hit, l); });
        };
        // Blended between the middles of the pixels, as pbrt-v4 does.
        expect_color(seen({0.5f, 0.9f}), {1, 1, 0}, 0.02f);
        expect_color(seen({0.5f, 0.5f}), Vec3(5, 5, 5) / 2.0f, 0.02f);
        expect_color(seen({0.75f, 0.625f}), Vec3(0, 2, 0) * 0.75f + Vec3(8, 8, 8) * 0.25f, 0.02f);
        expect_color(seen({0.1f, 0.9f}), {2, 0, 0}, 0.02f);
        expect_color(seen({0.9f, 0.9f}), {0, 2, 0}, 0.02f);
        expect_color(seen({0.1f, 0.1f}), {0, 0, 2}, 0.02f);
        expect_color(seen({0.9f, 0.1f}), {8, 8, 8}, 0.02f);
        // Mean 1.25, scale 2, area 1.
        expect_color(film_color(mode, [&](const Wavelengths& l) { return light->power(l); }), Vec3(2.5f * pi),
                     2e-3f);
        auto lumens =
            make_area_light({make_string("filename", "screen.pfm"), make_float("power", 10)}, setting)
                ->attach(shape, 0);
        expect_color(film_color(mode, [&](const Wavelengths& l) { return lumens->power(l); }), Vec3(10),
                     2e-3f);
    }
    Node both = make_node("diffuse", {make_string("filename", "screen.pfm"), make_rgb("L", 1, 1, 1)});
    EXPECT_EQ(build_error(area_light_kinds(), both, folder),
              "area light \"diffuse\" has both \"L\" and \"filename\"; it takes one of them");
    std::filesystem::remove_all(folder);
}

TEST(DiffuseAreaLight, ADescriptionAloneEmitsNothing) {
    auto description = make_area_light({});
    EXPECT_FALSE(description->sample({{0, 0, 1}, {}}, {0.5f, 0.5f}, Wavelengths::rgb()));
    EXPECT_TRUE(description->bounds()->bounds.empty());
}

} // namespace
} // namespace alhazen
