/// Relief in scenes: the same on instances as on the shapes themselves, and that of the material in effect.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/hash.h"
#include "math/warp.h"
#include "tests/support/render_scene.h"

namespace alhazen::testing {
namespace {

std::unique_ptr<World> world_of(const std::string& text) {
    Messages messages;
    return build_world(read_pbrt_string("WorldBegin\n" + text, ALHAZEN_SOURCE_DIR "/scenes", messages), {},
                       messages);
}

constexpr const char* bumpy = R"(
Texture "bumps" "float" "windy"
Material "diffuse" "texture displacement" "bumps"
)";

// From many sides; both worlds must show the same normals.
void expect_same_normals(const World& a, const World& b) {
    Rng rng(1);
    int turned = 0;
    for (int i = 0; i < 200; ++i) {
        const float u = rng.uniform();
        const Vec3 from = sample_sphere({u, rng.uniform()}) * 6;
        const Vec3 to{rng.uniform() - 0.5f, rng.uniform() - 0.5f, rng.uniform() - 0.5f};
        const Ray ray{from, to - from};
        auto hit = a.scene->closest(ray), other = b.scene->closest(ray);
        ASSERT_EQ(hit.has_value(), other.has_value());
        if (!hit) continue;
        EXPECT_LT(length(hit->ns - other->ns), 5e-3f) << i;
        EXPECT_LT(length(hit->ng - other->ng), 1e-4f) << i;
        if (dot(hit->ns, hit->ng) < 0.999f) ++turned;
    }
    EXPECT_GT(turned, 50);
}

TEST(Relief, IsTheSameOnInstances) {
    for (const char* shape : {R"(Shape "sphere" "float radius" .5)",
                              R"(Shape "bilinearmesh" "point3 P" [ -1 -1 0  1 -1 0  -1 1 0  1 1 .2 ])"}) {
        const std::string placed = "Translate .1 .2 .3 Rotate 30 1 2 3 Scale 2 2 2\n";
        expect_same_normals(*world_of(bumpy + placed + shape),
                            *world_of(fmt::format("{} ObjectBegin \"o\" {} ObjectEnd {} ObjectInstance \"o\"",
                                                  bumpy, shape, placed)));
    }
}

TEST(Relief, OfAMixtureIsThatOfTheMaterialInEffect) {
    auto world = world_of(R"(
Texture "bumps" "float" "windy"
MakeNamedMaterial "rough" "string type" "diffuse" "texture displacement" "bumps"
MakeNamedMaterial "smooth" "string type" "diffuse"
Material "mix" "string materials" [ "rough" "smooth" ]
Shape "sphere")");
    int turned = 0, smooth = 0;
    Rng rng(1);
    for (int i = 0; i < 200; ++i) {
        const float u = rng.uniform();
        const Vec3 from = sample_sphere({u, rng.uniform()}) * 6;
        auto hit = world->scene->closest({from, -from});
        ASSERT_TRUE(hit);
        const bool is_turned = length(hit->ns - hit->ng) > 1e-6f;
        EXPECT_EQ(is_turned, hit->material->has_relief());
        ++(is_turned ? turned : smooth);
    }
    EXPECT_GT(turned, 50);
    EXPECT_GT(smooth, 50);
}

} // namespace
} // namespace alhazen::testing
