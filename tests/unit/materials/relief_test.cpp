/// Bumps and normal maps: which way the shading normal turns.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "image/codec.h"
#include "materials/material_set.h"
#include "textures/texture_set.h"

namespace alhazen {

namespace {

using ::testing::HasSubstr;

struct Waves final : FloatNode {
    float height, u, v;
    Waves(float height_, float u_, float v_) : height(height_), u(u_), v(v_) {}
    float eval(const TexturePoint& at) const override { return height * std::sin(u * at.uv.x + v * at.uv.y); }
};
struct Ramp final : FloatNode {
    Vec2 slope;
    explicit Ramp(Vec2 s) : slope(s) {}
    float eval(const TexturePoint& at) const override { return slope.x * at.uv.x + slope.y * at.uv.y; }
};
struct ByPlace final : FloatNode {
    float eval(const TexturePoint& at) const override { return at.p.x * 0.5f; }
};
// Of one height where a pixel is known, rough where it is not.
struct BlurredAway final : FloatNode {
    float eval(const TexturePoint& at) const override {
        return at.hit && at.hit->cone ? 0.25f : std::sin(at.uv.x * 1e4f);
    }
};
struct Step final : FloatNode {
    float eval(const TexturePoint& at) const override { return at.uv.x > 0.5f ? 1.0f : 0.0f; }
};
struct Nonsense final : FloatNode {
    float eval(const TexturePoint& at) const override { return at.uv.x > 0.5f ? infinity : -infinity; }
};

Relief bumps(std::shared_ptr<const FloatNode> node) {
    Relief relief;
    relief.displacement = FloatTexture(std::move(node));
    return relief;
}

Hit plane() {
    Hit hit;
    hit.ng = hit.ns = {0, 0, 1};
    hit.dpdu = {2, 0, 0};
    hit.dpdv = {0, 3, 0};
    hit.uv = {0.5f, 0.5f};
    return hit;
}

void expect_near(Vec3 a, Vec3 b, float tolerance) {
    EXPECT_LE(length(a - b), tolerance)
        << a.x << " " << a.y << " " << a.z << ", expected " << b.x << " " << b.y << " " << b.z;
}

// Height per length is height per parameter over length per parameter.
TEST(Relief, RampTiltsAPlane) {
    Hit hit = plane();
    bumps(std::make_shared<Ramp>(Vec2{0.6f, -0.9f})).apply(hit, {});
    expect_near(hit.ns, normalize(Vec3(-0.3f, 0.3f, 1)), 1e-4f);
    expect_near(hit.ng, {0, 0, 1}, 0);
    expect_near(hit.dpdu, {2, 0, 0.6f}, 1e-3f);
    EXPECT_NEAR(dot(hit.ns, hit.dpdu), 0, 1e-3f);
}

// Textures of places are asked along the surface, too.
TEST(Relief, HeightsByPlaceTiltAPlane) {
    Hit hit = plane();
    bumps(std::make_shared<ByPlace>()).apply(hit, {});
    expect_near(hit.ns, normalize(Vec3(-0.5f, 0, 1)), 1e-3f);
}

// The normal is that of the surface raised for good.
TEST(Relief, BumpsOnASphereAreThoseOfTheRaisedSphere) {
    const Waves waves(0.3f, 3, 5);
    const float radius = 2;
    auto normal = [](float u, float v) {
        return Vec3(std::cos(u) * std::cos(v), std::sin(u) * std::cos(v), std::sin(v));
    };
    auto raised = [&](float u, float v) {
        return normal(u, v) * (radius + waves.eval(TexturePoint({}, {}, {u, v})));
    };
    for (float u : {0.3f, 2.0f})
        for (float v : {-0.5f, 0.1f, 1.0f})
            for (float side : {1.0f, -1.0f}) {
                Hit hit;
                hit.uv = {u, v};
                hit.ng = hit.ns = normal(u, v);
                hit.p = normal(u, v) * radius;
                hit.dpdu = Vec3(-std::sin(u) * std::cos(v), std::cos(u) * std::cos(v), 0) * radius;
                hit.dpdv = Vec3(-std::cos(u) * std::sin(v), -std::sin(u) * std::sin(v), std::cos(v)) * radius;
                NormalChange change{hit.dpdu / radius, hit.dpdv / radius};
                const float h = 0.01f;
                Vec3 expected = normalize(
                    cross(raised(u + h, v) - raised(u - h, v), raised(u, v + h) - raised(u, v - h)));
                if (side < 0) {
                    // Seen from inside, with the normal there, waves that go in are those that went out.
                    hit.ng = hit.ns = -hit.ns;
                    change = {-change.dndu, -change.dndv};
                    bumps(std::make_shared<Waves>(-0.3f, 3, 5)).apply(hit, change);
                } else {
                    bumps(std::make_shared<Waves>(waves)).apply(hit, change);
                }
                expect_near(hit.ns, expected * side, 3e-3f);
            }
}

// Seen straight from above by pixels of that width.
Hit plane_seen_by(PixelCone& cone, float width) {
    cone.parallel = {0, 0, -1};
    cone.width = width;
    Hit hit = plane();
    hit.cone = &cone;
    return hit;
}

// The heights that are compared are blurred alike.
TEST(Relief, BumpsFinerThanAPixelVanish) {
    PixelCone cone;
    Hit hit = plane_seen_by(cone, 0.2f);
    bumps(std::make_shared<BlurredAway>()).apply(hit, {});
    expect_near(hit.ns, {0, 0, 1}, 0);
}

// Pixels 0.2 wide cover 0.1 of u, whose unit is 2 long: a step as high as 1 rises by 1 over half of that.
TEST(Relief, HeightsAreComparedOverHalfAPixel) {
    PixelCone cone;
    Hit hit = plane_seen_by(cone, 0.2f);
    bumps(std::make_shared<Step>()).apply(hit, {});
    expect_near(hit.dpdu, {2, 0, 20}, 1e-3f);
    expect_near(hit.dpdv, {0, 3, 0}, 1e-3f);
    // Far from the world's origin no step is less than what rounding leaves exact.
    hit = plane_seen_by(cone, 1e-7f);
    hit.p = {1000, 0, 0};
    bumps(std::make_shared<ByPlace>()).apply(hit, {});
    expect_near(hit.ns, normalize(Vec3(-0.5f, 0, 1)), 0.1f);
}

TEST(Relief, WhatCannotBeTurnedStaysSmooth) {
    Hit hit = plane();
    hit.dpdu = hit.dpdv = {};
    bumps(std::make_shared<Ramp>(Vec2{0.6f, -0.9f})).apply(hit, {});
    EXPECT_TRUE(is_finite(hit.ns));
    hit = plane();
    bumps(std::make_shared<Nonsense>()).apply(hit, {});
    expect_near(hit.ns, {0, 0, 1}, 0);
    expect_near(hit.dpdu, {2, 0, 0}, 0);
}

// However steep, the shading normal stays on the geometric normal's side.
TEST(Relief, NormalsStayOutside) {
    Hit hit = plane();
    bumps(std::make_shared<Ramp>(Vec2{1e5f, 0})).apply(hit, {});
    EXPECT_GE(dot(hit.ns, hit.ng), 0);
    EXPECT_NEAR(length(hit.ns), 1, 1e-6f);
}

class NormalMapTest : public ::testing::Test {
  protected:
    // Two texels high: below, a normal tilted towards u; above, one that points out.
    static std::filesystem::path two_normals() {
        Image image = Image::rgb_image(1, 2);
        auto set = [&](int y, Vec3 n) {
            for (int c = 0; c < 3; ++c) image.at(0, y, c) = 0.5f * n[c] + 0.5f;
        };
        set(0, {0, 0, 1});
        set(1, {0.6f, 0, 0.8f});
        std::filesystem::path path = std::filesystem::path(::testing::TempDir()) / "two_normals.pfm";
        write_image(path, image);
        return path;
    }
    std::string message(const std::string& file) {
        Messages messages;
        BuildContext context{messages};
        TextureSet textures;
        textures.build({}, context);
        Node node;
        node.type = "diffuse";
        node.parameters = {make_string("normalmap", file)};
        MaterialSet set;
        set.build({node}, context);
        return messages.list().empty() ? "" : messages.list()[0].text;
    }
};

TEST_F(NormalMapTest, NormalsAreGivenInTheSurfacesFrame) {
    Relief relief;
    relief.normalmap = NormalMap(two_normals());
    Hit hit = plane();
    hit.uv = {0.3f, 0.25f};
    relief.apply(hit, {});
    expect_near(hit.ns, {0.6f, 0, 0.8f}, 1e-5f);
    expect_near(hit.dpdu, Vec3(0.8f, 0, -0.6f) * 2, 1e-5f);
    expect_near(hit.dpdv, Vec3(0, 3, 0), 1e-5f);
    hit = plane();
    hit.uv = {7.3f, -1.25f}; // repeats
    relief.apply(hit, {});
    expect_near(hit.ns, {0, 0, 1}, 1e-5f);
}

TEST_F(NormalMapTest, FilesThatAreNoneAreErrors) {
    EXPECT_EQ(message(two_normals().string()), "");
    EXPECT_THAT(message("missing.png"), HasSubstr("normal map"));
    EXPECT_THAT(message("missing.png"), HasSubstr("missing.png"));
    std::filesystem::path grey = std::filesystem::path(::testing::TempDir()) / "grey.pfm";
    write_image(grey, Image::grey_image(2, 2));
    EXPECT_THAT(message(grey.string()), HasSubstr("the image is grey; a normal map has three channels"));
}

} // namespace

} // namespace alhazen
