/// The rays are what their names say.
#include <gtest/gtest.h>

#include "lab/ray_sets.h"
#include "tests/unit/lab/scenes.h"

namespace alhazen {
namespace {

using namespace lab_test;

constexpr std::size_t wanted = 3072;

std::vector<RaySet> sets_of(const World& world) {
    return make_ray_sets(world, {wanted, 1});
}

TEST(RaySets, ComeInTheOrderOfTheirKindsAndInTheNumberAskedFor) {
    auto sets = sets_of(*mesh_world());
    ASSERT_EQ(sets.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(sets[i].kind, static_cast<RayKind>(i));
        EXPECT_EQ(sets[i].rays.size(), wanted) << name_of(sets[i].kind);
    }
}

TEST(RaySets, PicturesKeepTheFilmsShapeAndHaveWholeTiles) {
    EXPECT_EQ(tiled_size({64, 48}, 3072), (Vec2i{64, 48}));
    EXPECT_EQ(tiled_size({1920, 1080}, 100000), (Vec2i{424, 240}));
    EXPECT_EQ(tiled_size({1000, 1}, 64), (Vec2i{256, 8}));
    EXPECT_EQ(tiled_size({1, 1}, 1), (Vec2i{8, 8}));
}

TEST(RaySets, PrimaryRaysAreTheCamerasInTiles) {
    auto world = mesh_world();
    auto rays = sets_of(*world)[0].rays;
    // The second tile stands right of the first; the ninth begins the second row of tiles.
    for (auto [index, pixel] : {std::pair{0, Vec2i{0, 0}},
                                {7, Vec2i{7, 0}},
                                {8, Vec2i{0, 1}},
                                {64, Vec2i{8, 0}},
                                {64 * 8 + 9, Vec2i{1, 9}}}) {
        Ray expected = *camera_ray(*world, pixel, {64, 48});
        EXPECT_EQ(rays[static_cast<std::size_t>(index)].d, expected.d) << index;
        EXPECT_EQ(rays[static_cast<std::size_t>(index)].o, expected.o) << index;
    }
}

TEST(RaySets, DiffuseRaysLeaveTheSurfaceByTheCosine) {
    auto rays = sets_of(*world_of(view + lamp + ground))[1].rays;
    ASSERT_EQ(rays.size(), wanted);
    double sum = 0;
    for (const Ray& ray : rays) {
        EXPECT_GE(ray.o.y, 0);
        EXPECT_LT(ray.o.y, 1e-3f);
        EXPECT_GT(ray.d.y, 0);
        EXPECT_EQ(ray.tmax, infinity);
        sum += static_cast<double>(ray.d.y);
    }
    // The cosine's mean is 2/3 and its variance 1/18. Five standard deviations: a false alarm in 2 million
    // seeds.
    EXPECT_NEAR(sum / wanted, 2.0 / 3, 5 * std::sqrt(1.0 / 18 / wanted));
}

TEST(RaySets, AmbientOcclusionRaysAreShort) {
    auto sets = sets_of(*world_of(view + lamp + ground));
    // The ground is 4 away at the picture's middle, and less than 6 in its corners.
    for (const Ray& ray : sets[2].rays) {
        EXPECT_GT(ray.d.y, 0);
        EXPECT_GT(ray.tmax, 0.2f * 4);
        EXPECT_LT(ray.tmax, 0.2f * 6);
        EXPECT_EQ(ray.tmax, sets[2].rays.front().tmax);
    }
}

TEST(RaySets, ShadowRaysEndAtTheLight) {
    auto rays = sets_of(*world_of(view + lamp + ground))[3].rays;
    ASSERT_EQ(rays.size(), wanted);
    for (const Ray& ray : rays) {
        EXPECT_LT(length(ray.at(1) - Vec3{1, 3, 2}), 1e-4f);
        EXPECT_LT(ray.tmax, 1);
        EXPECT_GT(ray.tmax, 0.99f);
    }
}

TEST(RaySets, WithoutLightsShadowRaysEndInTheScenesBox) {
    auto world = world_of(view + ground + fence(16));
    auto rays = sets_of(*world)[3].rays;
    ASSERT_EQ(rays.size(), wanted);
    const Bounds3& box = world->scene->bounds();
    float highest = 0;
    for (const Ray& ray : rays) {
        Vec3 end = ray.at(1);
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GE(end[axis], box.lo[axis] - 1e-3f);
            EXPECT_LE(end[axis], box.hi[axis] + 1e-3f);
        }
        highest = std::max(highest, end.y);
    }
    EXPECT_GT(highest, 0.4f);
}

TEST(RaySets, DependOnTheSeedOnly) {
    auto world = mesh_world();
    auto a = sets_of(*world);
    AccelChoice other;
    other.builder = "lbvh";
    other.walk = "stackless";
    world->scene->rebuild(other);
    auto b = sets_of(*world), c = make_ray_sets(*world, {wanted, 2});
    for (std::size_t set = 0; set < 4; ++set) {
        std::size_t same = 0;
        for (std::size_t i = 0; i < wanted; ++i) {
            EXPECT_EQ(a[set].rays[i].o, b[set].rays[i].o);
            EXPECT_EQ(a[set].rays[i].d, b[set].rays[i].d);
            same += a[set].rays[i].d == c[set].rays[i].d;
        }
        if (set > 0) {
            EXPECT_LT(same, wanted / 10);
        }
    }
}

TEST(RaySets, ACameraThatSeesNothingHasPrimaryRaysOnly) {
    auto sets = sets_of(*world_of(view + lamp));
    EXPECT_EQ(sets[0].rays.size(), wanted);
    for (std::size_t i = 1; i < 4; ++i) EXPECT_TRUE(sets[i].rays.empty());
}

} // namespace
} // namespace alhazen
