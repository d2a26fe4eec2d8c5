/// Distance fields, and the kernels that march rays through them.
#include <gtest/gtest.h>

#include "base/hash.h"
#include "base/ray.h"
#include "math/warp.h"
#include "scene/distance_field.h"
#include "scene/march/dispatch.h"

namespace alhazen::testing {
namespace {

struct Marched {
    std::vector<float> t;
    std::vector<std::uint32_t> sample;
};

Marched march(const DistanceField& field, const std::vector<Ray>& rays,
              const MarchKernel& kernel = *supported_march_kernels().front(), float free_cells = 0) {
    Marched met{std::vector<float>(rays.size(), -1), std::vector<std::uint32_t>(rays.size())};
    if (!rays.empty())
        kernel.march(field.march_field(), {&rays[0].o.x, static_cast<std::uint32_t>(rays.size()), free_cells,
                                           met.t.data(), met.sample.data()});
    return met;
}

Vec3 random_point(Rng& rng, float size = 1) {
    const float x = rng.uniform(), y = rng.uniform(), z = rng.uniform();
    return Vec3{x - 0.5f, y - 0.5f, z - 0.5f} * (2 * size);
}
Vec3 random_direction(Rng& rng) {
    const float u = rng.uniform();
    return sample_sphere({u, rng.uniform()});
}

std::vector<Corners> some_triangles(int count, float size) {
    Rng rng(5);
    std::vector<Corners> triangles;
    for (int i = 0; i < count; ++i) {
        const Vec3 a = random_point(rng);
        const Vec3 b = a + random_point(rng, size);
        triangles.push_back({a, b, a + random_point(rng, size)});
    }
    return triangles;
}

// A square from -1 to 1, turned from the axes, on the plane y = at + slope x.
std::vector<Corners> square(float at, float slope = 0) {
    auto turned = [&](float x, float z) {
        const float across = 0.8f * x - 0.6f * z;
        return Vec3{across, at + slope * across, 0.6f * x + 0.8f * z};
    };
    const Vec3 a = turned(-1, -1), b = turned(1, -1), c = turned(1, 1), d = turned(-1, 1);
    return {{a, b, c}, {a, c, d}};
}

std::vector<Ray> some_rays(int count, float from) {
    Rng rng(9);
    std::vector<Ray> rays;
    for (int i = 0; i < count; ++i) {
        Ray ray{random_point(rng, from), random_direction(rng)};
        if (i % 3 == 0) ray.d *= 7;
        if (i % 4 == 0) ray.tmax = rng.uniform();
        rays.push_back(ray);
    }
    return rays;
}

// One of them, and none that is not.
TEST(DistanceField, KernelsGiveTheSameBits) {
    const DistanceField field(some_triangles(300, 0.3f), 60);
    for (int count : {0, 1, 7, 31, 33, 5000}) {
        const std::vector<Ray> rays = some_rays(count, 1.5f);
        const Marched expected = march(field, rays, *march_kernel_plain());
        for (const MarchKernel* kernel : supported_march_kernels()) {
            const Marched met = march(field, rays, *kernel);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                ASSERT_EQ(met.t[i], expected.t[i]) << kernel->name << " " << i;
                if (met.t[i] < infinity) {
                    ASSERT_EQ(met.sample[i], expected.sample[i]) << kernel->name;
                }
            }
        }
        // Nor does it matter in whose company they are.
        for (std::size_t i = 0; i < rays.size(); i += 17)
            ASSERT_EQ(march(field, {rays[i]}).t[0], expected.t[i]);
    }
}

TEST(DistanceField, WhatIsMetIsThere) {
    const std::vector<Corners> triangles = some_triangles(300, 0.3f);
    const DistanceField field(triangles, 60);
    const MeshDistance mesh(triangles);
    const std::vector<Ray> rays = some_rays(5000, 1.2f);
    const Marched met = march(field, rays);
    int count = 0, far = 0;
    double sum = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!(met.t[i] < infinity)) continue;
        ++count;
        ASSERT_GT(met.t[i], 0);
        ASSERT_LT(met.t[i], rays[i].tmax);
        const double distance =
            mesh.nearest(Vec3d(rays[i].at(met.t[i])), static_cast<double>(infinity))->distance / field.cell();
        // In or close to the cell of a sample that is no farther than a cell from its triangle.
        ASSERT_LT(distance, 2) << i;
        far += distance > 0.5;
        sum += distance;
        EXPECT_LT(field.triangle(met.sample[i]), triangles.size());
    }
    EXPECT_GT(count, 1500);
    // Nearly all on the triangles themselves.
    EXPECT_LT(sum / count, 0.15);
    EXPECT_LT(far, 0.12 * count);
}

// The way past what is not near is free, however far it is: nothing is met in front of a wall, and the wall
// where it is, wherever that is among the samples.
TEST(DistanceField, AWallIsMetWhereItIs) {
    for (float below : {0.0f, -1.237f, -1.2456f, -1.3333f, -1.3421f})
        for (float slope : {0.0f, 0.2f, -0.73f}) {
            SCOPED_TRACE(std::to_string(below) + " " + std::to_string(slope));
            std::vector<Corners> triangles = square(0, slope);
            for (const Corners& c : square(3)) triangles.push_back(c); // the field is deep
            if (below < 0) triangles.push_back({{3, below, 3}, {3.1f, below, 3}, {3, below, 3.1f}});
            const DistanceField field(triangles, 100);
            const float along_normal = 1 / std::sqrt(1 + slope * slope);
            Rng rng(3);
            std::vector<Ray> rays;
            std::vector<float> expected, cosines;
            while (rays.size() < 2000) {
                const Vec3 from = random_point(rng, 0.3f) + Vec3{0, 1.6f, 0};
                Vec3 to{random_point(rng, 0.6f).x, 0, random_point(rng, 0.6f).z};
                to.y = slope * to.x;
                rays.push_back({from, normalize(to - from)});
                expected.push_back(length(to - from));
                cosines.push_back(std::abs(rays.back().d.y - slope * rays.back().d.x) * along_normal);
            }
            const Marched met = march(field, rays);
            const auto cell = static_cast<float>(field.cell());
            for (std::size_t i = 0; i < rays.size(); ++i) {
                // The plane is known to a fiftieth of a cell.
                ASSERT_NEAR(met.t[i] * cosines[i], expected[i] * cosines[i], 0.02f * cell) << i;
                EXPECT_LT(field.triangle(met.sample[i]), 2u);
            }
            // A shade before the wall they end, and at it.
            for (std::size_t i = 0; i < rays.size(); ++i)
                rays[i].tmax = expected[i] - 0.1f * cell / cosines[i];
            for (float t : march(field, rays).t) ASSERT_EQ(t, infinity);
            for (std::size_t i = 0; i < rays.size(); ++i) rays[i].tmax = expected[i] + 0.05f * cell;
            for (float t : march(field, rays, *supported_march_kernels().front(), 0.2f).t)
                ASSERT_EQ(t, infinity);
        }
}

// From a million cells away, beside walls and along the sides of cells, where steps are shortest.
TEST(DistanceField, RaysFromAfarArriveAndEnd) {
    std::vector<Corners> triangles = square(0);
    triangles.push_back({{-1, -1, 0.3f}, {-1, 1, 0.3f}, {-0.99f, 0, 0.3f}});
    const DistanceField field(triangles, 64);
    for (float far : {1e2f, 1e4f, 3e4f, 1e6f}) {
        std::vector<Ray> rays;
        for (float y : {0.0f, 1e-3f, 0.01f, 0.02f, 0.5f})
            for (float z : {0.0f, 0.1f, 0.25f}) {
                rays.push_back({{far, y, z}, {-1, 0, 0}});
                rays.push_back({{far, y, z}, {-1, -1e-9f, -1e-7f}});
                rays.push_back({{-far, y, z}, {1, 0, 3e-6f}});
            }
        for (float t : march(field, rays).t) EXPECT_TRUE(t == infinity || std::abs(t - far) < 2) << t;
        const float there = march(field, {Ray{{0.1f, far, 0.2f}, {0, -1, 0}}}).t[0];
        EXPECT_NEAR(there, far, 1e-3f + far * 1e-6f);
    }
}

// Grazing ones too, to both sides.
TEST(DistanceField, RaysThatLeaveAWallDoNotMeetItAgain) {
    const DistanceField field(square(0.123f), 64);
    Rng rng(4);
    std::vector<Ray> rays;
    for (int i = 0; i < 4000; ++i) {
        const Vec3 from{random_point(rng, 0.7f).x, 0.123f, random_point(rng, 0.7f).z};
        Vec3 d = random_direction(rng);
        if (std::abs(d.y) < 0.03f) d.y = std::copysign(0.03f, d.y);
        rays.push_back({from, normalize(d)});
    }
    for (float t : march(field, rays).t) ASSERT_EQ(t, infinity);
}

TEST(DistanceField, OddRaysMeetNothingOrWhatOthersMeet) {
    const DistanceField field(square(0), 64);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    auto t_of = [&](const Ray& ray) { return march(field, {ray}).t[0]; };
    const Vec3 from{0.1f, 0.5f, 0.2f}, down{0, -1, 0};
    EXPECT_NEAR(t_of({from, down}), 0.5f, 1e-3f);
    // Directions of any length, -0 among their parts.
    for (float size : {1e-30f, 1e-10f, 3.0f, 1e15f, 1e30f})
        EXPECT_NEAR(t_of({from, Vec3{-0.0f, -size, -0.0f}}) * size, 0.5f, 1e-3f) << size;
    for (const Ray& ray :
         {Ray{from, {0, 0, 0}}, Ray{from, {nan, -1, 0}}, Ray{from, {0, -infinity, 0}}, Ray{{0, nan, 0}, down},
          Ray{{0, infinity, 0}, down}, Ray{from, down, nan}, Ray{from, down, 0}, Ray{from, down, -1},
          Ray{from, {0, 1, 0}}, Ray{{9, 0.5f, 0}, down}, Ray{{9, 0.01f, 0}, {1, 0, 0}}})
        EXPECT_EQ(t_of(ray), infinity) << ray.o.x << " " << ray.o.y << " " << ray.d.y << " " << ray.tmax;
    // From outside of the field.
    EXPECT_NEAR(t_of({{0, 70, 0}, down}), 70, 0.01f);
}

TEST(DistanceField, BricksFarFromEverythingTakeNoMemory) {
    // Two small things far from each other.
    std::vector<Corners> triangles{{{0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}},
                                   {{9, 9, 9}, {9.1f, 9, 9}, {9, 9.1f, 9}}};
    const DistanceField field(triangles, 256);
    EXPECT_LT(field.bytes(), std::size_t{3} << 20); // 260^3 samples would be 140 MB
    const Ray ray{{0.02f, 0.02f, -1}, {0, 0, 1}};
    EXPECT_NEAR(march(field, {ray}).t[0], 1, 1e-2f);
}

TEST(DistanceField, NeedsAnExtent) {
    EXPECT_THROW(DistanceField({{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}}, 32), std::runtime_error);
}

} // namespace
} // namespace alhazen::testing
