#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <limits>

#include "tests/unit/accel/support.h"

namespace alhazen {
namespace {

using namespace accel_test;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

void expect_agreement(const Triangles& triangles, float scale, int rays, std::uint64_t seed) {
    Bvh bvh(triangles.boxes());
    Rng rng(seed);
    int hits = 0;
    for (int i = 0; i < rays; ++i) {
        Ray ray = random_ray(triangles, scale, rng);
        if (rng.below(4) == 0) ray.tmax = rng.uniform();
        Intersection expected = triangles.brute_force(ray), hit;
        bool found = bvh.closest(ray, hit, triangles.leaf(ray));
        ASSERT_EQ(found, expected.found()) << "ray " << i;
        ASSERT_EQ(hit.primitive, expected.primitive) << "ray " << i;
        ASSERT_EQ(hit.t, expected.t) << "ray " << i;
        ASSERT_EQ(hit.u, expected.u);
        ASSERT_EQ(bvh.any(ray, triangles.leaf(ray)), found) << "ray " << i;
        hits += found;
    }
    EXPECT_GT(hits, rays / 10);
}

TEST(Bvh, AgreesWithBruteForceAtEveryScale) {
    for (float scale : {1e-6f, 1.0f, 1e6f})
        expect_agreement(random_triangles(300, scale, 0.2f * scale, 1), scale, 4000, 2);
}

TEST(Bvh, AgreesWithBruteForceFarFromTheOrigin) {
    Triangles t = random_triangles(300, 1, 0.2f, 3);
    for (Triangle& triangle : t.list)
        for (Vec3* p : {&triangle.a, &triangle.b, &triangle.c}) *p += Vec3{1000, -2000, 500};
    Bvh bvh(t.boxes());
    Rng rng(4);
    for (int i = 0; i < 4000; ++i) {
        const Triangle& target = t.list[rng.below(300)];
        Vec3 o = random_point(rng, 3000);
        Ray ray{o, lerp(rng.uniform(), target.a, target.b) - o};
        Intersection hit, expected = t.brute_force(ray);
        bvh.closest(ray, hit, t.leaf(ray));
        ASSERT_EQ(hit.primitive, expected.primitive);
        ASSERT_EQ(hit.t, expected.t);
    }
}

TEST(Bvh, AgreesOnSliversAndFlatTriangles) {
    Triangles t = random_triangles(300, 1, 0.5f, 5);
    for (std::size_t i = 0; i < t.list.size(); ++i) {
        if (i % 3 == 0) t.list[i].c = lerp(1e-6f, t.list[i].b, t.list[i].c);
        if (i % 3 == 1) t.list[i].a.x = t.list[i].b.x = t.list[i].c.x;
        if (i % 30 == 2) t.list[i].c = t.list[i].b;
    }
    expect_agreement(t, 1, 4000, 6);
}

TEST(Bvh, TakesTheLowestNumberOfCoincidentTriangles) {
    Triangles t = random_triangles(50, 1, 1, 7);
    for (int copy = 0; copy < 10; ++copy)
        for (std::size_t i = 0; i < 50; ++i) t.list.push_back(t.list[i]);
    expect_agreement(t, 1, 3000, 8);
    // Also where the last is met first.
    std::swap(t.list[0], t.list[549]);
    expect_agreement(t, 1, 3000, 9);
}

TEST(Bvh, AGridMeshAgreesForRaysInItsPlanesAndThroughItsVertices) {
    Triangles t;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            auto at = [](int i, int j) {
                return Vec3{static_cast<float>(i), static_cast<float>(j), static_cast<float>((i * j) % 3)};
            };
            t.list.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
            t.list.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
        }
    expect_agreement(t, 16, 4000, 10);
}

TEST(Bvh, LeavesItsNumbersToTheLeafWhenTheLeafSetsThem) {
    std::vector<Bounds3> boxes{{{0, 0, 0}, {1, 1, 1}}};
    Bvh bvh(boxes);
    Intersection hit;
    ASSERT_TRUE(
        bvh.closest({{-1, .5f, .5f}, {1, 0, 0}}, hit, [](std::uint32_t, Ray&, Intersection& candidate) {
            candidate.t = 1;
            candidate.primitive = 77;
            candidate.instance = 3;
            return true;
        }));
    EXPECT_EQ(hit.primitive, 77u);
    EXPECT_EQ(hit.instance, 3u);
}

// A leaf that says yes to everything counts what the walk offers.
struct Counter {
    int calls = 0;
    bool operator()(std::uint32_t, const Ray&, Intersection&) {
        ++calls;
        return false;
    }
};

TEST(Bvh, EmptyAndExcludedInputIsNeverHit) {
    std::vector<Bounds3> boxes;
    EXPECT_TRUE(Bvh(boxes).bounds().empty());
    EXPECT_TRUE(Bvh().bounds().empty());
    boxes = {Bounds3{},
             {{nan, 0, 0}, {1, 1, 1}},
             {{0, 0, 0}, {1, nan, 1}},
             {{-infinity, 0, 0}, {1, 1, 1}},
             {{0, 0, 0}, {1, 1, infinity}}};
    Bvh bvh(boxes);
    EXPECT_EQ(bvh.primitive_count(), 0u);
    Counter counter;
    EXPECT_FALSE(bvh.any({{-5, .5f, .5f}, {1, 0, 0}}, counter));
    EXPECT_EQ(counter.calls, 0);
    // The one good box is found among bad ones, under its own number.
    boxes.push_back({{0, 0, 0}, {1, 1, 1}});
    Bvh one(boxes);
    EXPECT_EQ(one.primitive_count(), 1u);
    std::uint32_t offered = 0;
    one.any({{-5, .5f, .5f}, {1, 0, 0}}, [&](std::uint32_t p, Ray&, Intersection&) {
        offered = p;
        return true;
    });
    EXPECT_EQ(offered, 5u);
}

TEST(Bvh, RaysThatAreNotRaysHitNothing) {
    Triangles t = random_triangles(100, 1, 2, 11);
    Bvh bvh(t.boxes());
    for (float bad : {nan, infinity, -infinity})
        for (int axis = 0; axis < 3; ++axis)
            for (bool in_origin : {false, true}) {
                Ray ray{{0, 0, -5}, {0, 0, 1}};
                (in_origin ? ray.o : ray.d)[axis] = bad;
                Counter counter;
                EXPECT_FALSE(bvh.any(ray, counter));
                EXPECT_EQ(counter.calls, 0);
            }
    Counter counter;
    EXPECT_FALSE(bvh.any({{0, 0, -5}, {0, 0, 0}}, counter));
    EXPECT_FALSE(bvh.any({{0, 0, -5}, {0, 0, 1}, nan}, counter));
    EXPECT_FALSE(bvh.any({{0, 0, -5}, {0, 0, 1}, 0}, counter));
    EXPECT_FALSE(bvh.any({{0, 0, -5}, {0, 0, 1}, -1}, counter));
    EXPECT_EQ(counter.calls, 0);
}

TEST(Bvh, AxisParallelRaysOnTheFacesOfFlatBoxesSeeThem) {
    // Points and plates: boxes without volume, met exactly.
    std::vector<Bounds3> boxes;
    for (int i = 0; i < 100; ++i) {
        Vec3 p{static_cast<float>(i % 10), static_cast<float>(i / 10), 0};
        boxes.push_back({p, p});
    }
    Bvh bvh(boxes);
    for (int i = 0; i < 100; ++i) {
        Vec3 p = boxes[static_cast<std::size_t>(i)].lo;
        for (Vec3 d : {Vec3{0, 0, 1}, Vec3{0, 0, -1}, Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{-0.0f, 1, -0.0f}}) {
            bool offered = false;
            bvh.any({p - d * 20, d}, [&](std::uint32_t k, Ray&, Intersection&) {
                offered |= k == static_cast<std::uint32_t>(i);
                return false;
            });
            EXPECT_TRUE(offered) << i;
        }
    }
}

TEST(Bvh, VisitsLittleOfALargeInput) {
    Triangles t = random_triangles(100000, 1, 0.005f, 12);
    Bvh bvh(t.boxes());
    Rng rng(13);
    long calls = 0;
    for (int i = 0; i < 300; ++i) {
        Ray ray = random_ray(t, 1, rng);
        Intersection hit, expected = t.brute_force(ray);
        auto leaf = t.leaf(ray);
        bvh.closest(ray, hit, [&](std::uint32_t p, const Ray& r, Intersection& candidate) {
            ++calls;
            return leaf(p, r, candidate);
        });
        ASSERT_EQ(hit.primitive, expected.primitive);
        ASSERT_EQ(hit.t, expected.t);
    }
    // Measured: 1.1 a ray.
    EXPECT_LT(calls, 300 * 10);
}

} // namespace
} // namespace alhazen
