/// Every builder with every walk against trying every primitive: the same hits, bit by bit.

#include <gtest/gtest.h>

#include <limits>

#include "accel/moving.h"
#include "tests/unit/accel/support.h"

namespace alhazen {
namespace {

using namespace accel_test;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

class Pairs : public testing::TestWithParam<AccelChoice> {
  protected:
    std::unique_ptr<Structure> make(const Primitives& primitives) {
        return make_structure(primitives, GetParam());
    }

    void expect_agreement(const Triangles& triangles, const std::vector<Ray>& rays, std::size_t least_hits) {
        expect_agreement(*make(triangles), triangles, rays, least_hits);
    }
    // One ray at a time, counted, and all in one batch.
    void expect_agreement(const Structure& structure, const Triangles& triangles,
                          const std::vector<Ray>& rays, std::size_t least_hits) {
        TriangleTests tests(triangles);
        std::vector<Intersection> batch(rays.size());
        std::vector<std::uint8_t> blocked(rays.size(), 7);
        structure.closest(rays, batch, tests);
        structure.any(rays, blocked, tests);
        std::size_t hits = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            Intersection expected = triangles.brute_force(rays[i]), hit;
            WalkCounts counts;
            ASSERT_EQ(structure.closest(rays[i], hit, tests), expected.found()) << "ray " << i;
            expect_same(hit, expected, i);
            expect_same(batch[i], expected, i);
            ASSERT_EQ(structure.any(rays[i], tests), expected.found()) << "ray " << i;
            ASSERT_EQ(blocked[i], expected.found()) << "ray " << i;
            ASSERT_EQ(structure.count(Query::closest, rays[i], tests, counts), expected.found());
            ASSERT_EQ(structure.count(Query::any, rays[i], tests, counts), expected.found());
            if (HasFatalFailure()) return;
            hits += expected.found();
        }
        EXPECT_GE(hits, least_hits);
    }
    static void expect_same(const Intersection& hit, const Intersection& expected, std::size_t ray) {
        ASSERT_EQ(hit.primitive, expected.primitive) << "ray " << ray;
        ASSERT_EQ(hit.t, expected.t) << "ray " << ray;
        ASSERT_EQ(hit.u, expected.u) << "ray " << ray;
        ASSERT_EQ(hit.v, expected.v) << "ray " << ray;
    }
    static std::vector<Ray> random_rays(const Triangles& triangles, float scale, std::size_t count,
                                        std::uint64_t seed) {
        Rng rng(seed);
        std::vector<Ray> rays;
        for (std::size_t i = 0; i < count; ++i) {
            rays.push_back(random_ray(triangles, scale, rng));
            if (rng.below(4) == 0) rays.back().tmax = rng.uniform();
        }
        return rays;
    }
    // The pairs of the usual builder get more rays; with all pairs the suite would take minutes.
    static std::size_t ray_count() { return GetParam().builder == "sah" ? 4000 : 600; }
    void expect_agreement(const Triangles& triangles, float scale, std::uint64_t seed) {
        expect_agreement(triangles, random_rays(triangles, scale, ray_count(), seed), ray_count() / 10);
    }
};

TEST_P(Pairs, AgreeAtEveryScale) {
    for (float scale : {1e-6f, 1.0f, 1e6f})
        expect_agreement(random_triangles(300, scale, 0.2f * scale, 1), scale, 2);
}

TEST_P(Pairs, AgreeFarFromTheOrigin) {
    Triangles t = random_triangles(300, 1, 0.2f, 3);
    for (Corners& triangle : t.list)
        for (Vec3* p : {&triangle.a, &triangle.b, &triangle.c}) *p += Vec3{1000, -2000, 500};
    Rng rng(4);
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < ray_count(); ++i) {
        const Corners& target = t.list[rng.below(300)];
        Vec3 o = random_point(rng, 3000);
        rays.push_back({o, lerp(rng.uniform(), target.a, target.b) - o});
    }
    expect_agreement(t, rays, ray_count() / 4);
}

TEST_P(Pairs, AgreeOnSliversAndFlatTriangles) {
    Triangles t = random_triangles(300, 1, 0.5f, 5);
    for (std::size_t i = 0; i < t.list.size(); ++i) {
        if (i % 3 == 0) t.list[i].c = lerp(1e-6f, t.list[i].b, t.list[i].c);
        if (i % 3 == 1) t.list[i].a.x = t.list[i].b.x = t.list[i].c.x;
        if (i % 30 == 2) t.list[i].c = t.list[i].b;
    }
    expect_agreement(t, 1, 6);
}

TEST_P(Pairs, TakeTheLowestNumberOfCoincidentTriangles) {
    Triangles t = random_triangles(50, 1, 1, 7);
    for (int copy = 0; copy < 10; ++copy) t.list.insert(t.list.end(), t.list.begin(), t.list.begin() + 50);
    expect_agreement(t, 1, 8);
    // Also where the last is met first.
    std::swap(t.list[0], t.list[549]);
    expect_agreement(t, 1, 9);
}

Triangles grid(int size) {
    Triangles t;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            auto at = [](int i, int j) {
                return Vec3{static_cast<float>(i), static_cast<float>(j), static_cast<float>((i * j) % 3)};
            };
            t.list.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
            t.list.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
        }
    return t;
}

TEST_P(Pairs, AgreeInTheGridsPlanesAndThroughItsVertices) {
    expect_agreement(grid(16), 16, 10);
}

TEST_P(Pairs, AgreeWithCustomAndFilteredPrimitivesMixedIn) {
    Triangles t = random_triangles(600, 1, 0.3f, 11);
    for (std::size_t i = 0; i < t.list.size(); ++i)
        t.kinds.push_back(i % 7 < 3   ? PrimitiveKind::triangle
                          : i % 7 < 5 ? PrimitiveKind::filtered_triangle
                                      : PrimitiveKind::custom);
    expect_agreement(t, 1, 12);
    t.kinds.assign(t.list.size(), PrimitiveKind::custom);
    expect_agreement(t, 1, 13);
    t.kinds.assign(t.list.size(), PrimitiveKind::filtered_triangle);
    expect_agreement(t, 1, 14);
}

TEST_P(Pairs, AgreeOnAnyNumberOfPrimitives) {
    for (std::size_t n : {1u, 2u, 3u, 7u, 8u, 9u, 17u, 65u}) {
        Triangles t = random_triangles(n, 1, 1, 20 + n);
        expect_agreement(t, random_rays(t, 1, 200, n), 10);
    }
}

TEST_P(Pairs, FindNothingWhereNothingIs) {
    Triangles none;
    auto structure = make(none);
    EXPECT_TRUE(structure->bounds().empty());
    NoTests tests;
    Intersection hit;
    EXPECT_FALSE(structure->closest({{0, 0, 0}, {0, 0, 1}}, hit, tests));
    EXPECT_FALSE(structure->any({{0, 0, 0}, {0, 0, 1}}, tests));
    structure->closest(std::span<const Ray>{}, {}, tests);
    // Triangles without area, and with vertices that are no points, are never hit.
    Triangles bad({{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}},
                   {{nan, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                   {{0, 0, 0}, {infinity, 0, 0}, {0, 1, 0}}});
    structure = make(bad);
    EXPECT_FALSE(structure->any({{.1f, .1f, -1}, {0, 0, 1}}, tests));
    // The one good one is found among them, under its own number.
    bad.list.push_back({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    structure = make(bad);
    ASSERT_TRUE(structure->closest({{.1f, .1f, -1}, {0, 0, 1}}, hit, tests));
    EXPECT_EQ(hit.primitive, 3u);
}

TEST_P(Pairs, RaysThatAreNotRaysHitNothing) {
    Triangles t = random_triangles(100, 1, 2, 15);
    std::vector<Ray> rays;
    for (float bad : {nan, infinity, -infinity})
        for (int axis = 0; axis < 3; ++axis)
            for (bool in_origin : {false, true}) {
                Ray ray{{0, 0, -5}, {0, 0, 1}};
                (in_origin ? ray.o : ray.d)[axis] = bad;
                rays.push_back(ray);
            }
    rays.push_back({{0, 0, -5}, {0, 0, 0}});
    for (float tmax : {nan, 0.0f, -1.0f}) rays.push_back({{0, 0, -5}, {0, 0, 1}, tmax});
    auto structure = make(t);
    NoTests tests;
    std::vector<Intersection> hits(rays.size());
    std::vector<std::uint8_t> blocked(rays.size(), 7);
    structure->closest(rays, hits, tests);
    structure->any(rays, blocked, tests);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        Intersection hit;
        EXPECT_FALSE(structure->closest(rays[i], hit, tests)) << i;
        EXPECT_FALSE(structure->any(rays[i], tests)) << i;
        EXPECT_FALSE(hits[i].found()) << i;
        EXPECT_EQ(blocked[i], 0) << i;
    }
}

TEST_P(Pairs, DirectionsOfAnyLengthFindTheSame) {
    Triangles t = random_triangles(300, 1, 0.3f, 16);
    std::vector<Ray> rays = random_rays(t, 1, 500, 17);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        rays[i].tmax = infinity;
        rays[i].d = rays[i].d * std::ldexp(1.0f, static_cast<int>(i % 80) - 40);
    }
    expect_agreement(t, rays, 50);
}

TEST_P(Pairs, FollowPrimitivesThatMove) {
    Triangles t = random_triangles(300, 1, 0.3f, 21);
    for (std::size_t i = 0; i < t.list.size(); ++i)
        t.kinds.push_back(i % 5 < 3   ? PrimitiveKind::triangle
                          : i % 5 < 4 ? PrimitiveKind::filtered_triangle
                                      : PrimitiveKind::custom);
    MovingStructure moving(t, GetParam());
    const double cost = moving.expected_cost();
    Rng rng(22);
    const std::vector<Corners> start = t.list;
    for (float distance : {0.05f, 0.3f, 3.0f}) {
        for (std::size_t i = 0; i < t.list.size(); ++i) {
            const Vec3 shift = random_point(rng, distance);
            t.list[i] = {start[i].a + shift, start[i].b + shift, start[i].c + random_point(rng, 0.2f)};
            // Some cannot be hit for a while.
            if (i % 11 == 0) t.list[i].b = t.list[i].a;
            if (i % 17 == 0) t.list[i].c.x = nan;
        }
        EXPECT_TRUE(moving.update(t));
        const std::vector<Ray> rays = random_rays(t, 1, ray_count() / 2, 23);
        expect_agreement(moving.structure(), t, rays, rays.size() / 20);
    }
    EXPECT_GT(moving.expected_cost(), cost);
    t.list = start;
    EXPECT_TRUE(moving.update(t));
    expect_agreement(moving.structure(), t, random_rays(t, 1, ray_count() / 2, 24), ray_count() / 20);
}

TEST_P(Pairs, AreBuiltAnewForPrimitivesThatWereNotThere) {
    Triangles t = random_triangles(40, 1, 0.5f, 25);
    const Corners one = t.list[3];
    t.list[3].b = t.list[3].a;
    MovingStructure moving(t, GetParam());
    t.list[3] = one;
    EXPECT_FALSE(moving.update(t));
    expect_agreement(moving.structure(), t, random_rays(t, 1, 200, 26), 20);
    for (Corners& triangle : t.list) triangle.b = triangle.a;
    EXPECT_FALSE(moving.update(t));
    EXPECT_TRUE(moving.structure().bounds().empty());
}

TEST_P(Pairs, VisitLittleOfALargeInput) {
    const bool is_usual = GetParam().builder == "sah";
    Triangles t = is_usual ? random_triangles(100000, 1, 0.005f, 18) : random_triangles(20000, 1, 0.01f, 18);
    auto structure = make(t);
    NoTests tests;
    Rng rng(19);
    WalkCounts counts;
    const std::uint64_t rays = is_usual ? 300 : 100;
    for (std::uint64_t i = 0; i < rays; ++i) {
        Ray ray = random_ray(t, 1, rng);
        Intersection hit, expected = t.brute_force(ray);
        structure->closest(ray, hit, tests);
        ASSERT_EQ(hit.primitive, expected.primitive);
        ASSERT_EQ(hit.t, expected.t);
        structure->count(Query::closest, ray, tests, counts);
    }
    RecordProperty("leaves", std::to_string(counts.leaves));
    EXPECT_LT(counts.leaves, rays * 10);
    EXPECT_GT(counts.nodes, rays);
}

std::string name_of(const testing::TestParamInfo<AccelChoice>& info) {
    std::string name = info.param.builder + "_" + info.param.walk;
    std::replace(name.begin(), name.end(), '+', '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(All, Pairs, testing::ValuesIn(all_choices()), name_of);

} // namespace
} // namespace alhazen
