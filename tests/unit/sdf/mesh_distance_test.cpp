/// Distances, winding numbers and grids of meshes against brute force and against bodies that are known.

#include <gtest/gtest.h>

#include "base/hash.h"
#include "base/threads.h"
#include "sdf/mesh_grid.h"
#include "sdf/tessellate.h"
#include "sdf/voxel_field.h"
#include "tests/support/sdf_world.h"

namespace alhazen {
namespace {

using namespace testing_support;

// A fine mesh of the pebble, every triangle oriented outward.
std::vector<Corners> pebble_mesh(int levels) {
    const PlacedSdf& field = *example_sdfs().find("pebble");
    std::vector<Corners> mesh;
    for (const SdfTriangle& t : tessellate(field, levels)) {
        Vec3d n = cross(t[1] - t[0], t[2] - t[0]),
              g = field.value(dual_point((t[0] + t[1] + t[2]) * (1.0 / 3))).d;
        bool is_outward = dot(n, g) > 0;
        mesh.push_back({Vec3(t[0]), Vec3(t[is_outward ? 1 : 2]), Vec3(t[is_outward ? 2 : 1])});
    }
    return mesh;
}

Vec3d random_point(Rng& rng, double reach) {
    auto number = [&] { return reach * (2 * static_cast<double>(rng.uniform()) - 1); };
    return {number(), number(), number()};
}

double winding_by_sum(const std::vector<Corners>& mesh, Vec3d p) {
    double sum = 0;
    for (const Corners& t : mesh) {
        Vec3d a = normalize(Vec3d(t.a) - p), b = normalize(Vec3d(t.b) - p), c = normalize(Vec3d(t.c) - p);
        sum += 2 * std::atan2(dot(a, cross(b, c)), 1 + dot(a, b) + dot(b, c) + dot(c, a));
    }
    return sum / (4 * 3.14159265358979323846);
}

TEST(MeshDistances, AreThoseOfTheNearestTriangle) {
    std::vector<Corners> mesh = pebble_mesh(4);
    MeshDistance distance(mesh);
    Rng rng(1);
    for (int i = 0; i < 300; ++i) {
        Vec3d p = random_point(rng, 2);
        double least = Box::far;
        for (const Corners& t : mesh) {
            Vec3d q = nearest_on_triangle(Vec3d(t.a), Vec3d(t.b), Vec3d(t.c), p).p;
            least = std::min(least, length(q - p));
        }
        auto found = distance.nearest(p, 100);
        ASSERT_TRUE(found);
        ASSERT_DOUBLE_EQ(found->distance, least);
        ASSERT_NEAR(length(found->at.p - p), least, 1e-12);
        EXPECT_FALSE(distance.nearest(p, least * 0.999));
    }
}

// The nearest point of one triangle: no other point of it is nearer, and its weights give it.
TEST(MeshDistances, NearestPointsOfTrianglesAreNearest) {
    Rng rng(2);
    for (int i = 0; i < 3000; ++i) {
        Vec3d a = random_point(rng, 1), b = random_point(rng, 1), c = random_point(rng, 1);
        if (i % 10 == 0) c = a + (b - a) * 0.3; // without area
        Vec3d p = random_point(rng, 2);
        TrianglePoint at = nearest_on_triangle(a, b, c, p);
        ASSERT_NEAR(length(a + (b - a) * at.b + (c - a) * at.c - at.p), 0, 1e-12);
        ASSERT_GE(std::min({at.b, at.c, 1 - at.b - at.c}), -1e-12);
        for (int k = 0; k < 30; ++k) {
            double u = static_cast<double>(rng.uniform()), v = static_cast<double>(rng.uniform()) * (1 - u);
            ASSERT_GE(length(a + (b - a) * u + (c - a) * v - p), length(at.p - p) - 1e-9);
        }
    }
}

TEST(WindingNumbers, AreTheSumOfAllSolidAngles) {
    std::vector<Corners> mesh = pebble_mesh(5);
    // Flawed: a hole, and some triangles twice.
    std::erase_if(mesh, [](const Corners& t) { return t.a.z > 0.55f; });
    mesh.insert(mesh.end(), mesh.begin(), mesh.begin() + 40);
    MeshDistance distance(mesh);
    Rng rng(3);
    for (int i = 0; i < 400; ++i) {
        Vec3d p = random_point(rng, 2);
        ASSERT_NEAR(distance.winding_number(p), winding_by_sum(mesh, p), 0.02);
    }
}

TEST(WindingNumbers, TellInsideFromOutsideHoweverTheTrianglesAreOriented) {
    const PlacedSdf& field = *example_sdfs().find("pebble");
    std::vector<Corners> mesh = pebble_mesh(5), turned = mesh;
    for (Corners& t : turned) std::swap(t.b, t.c);
    Rng rng(4);
    for (const auto& m : {mesh, turned}) {
        MeshDistance distance(m);
        for (int i = 0; i < 1000; ++i) {
            Vec3d p = random_point(rng, 1.3);
            double f = field.value(p);
            if (std::abs(f) < 0.01) continue;
            ASSERT_EQ(distance.is_inside(p), f < 0);
        }
    }
}

TEST(MeshGrids, HoldTheDistanceOfTheBody) {
    SdfSet set = make_sdfs({sdf_node("ball", "sphere", {make_float("radius", 0.75f)})});
    const PlacedSdf& ball = *set.find("ball");
    std::vector<Corners> mesh;
    for (const SdfTriangle& t : tessellate(ball, 5)) {
        bool is_outward = dot(cross(t[1] - t[0], t[2] - t[0]), t[0]) > 0;
        mesh.push_back({Vec3(t[0]), Vec3(t[is_outward ? 1 : 2]), Vec3(t[is_outward ? 2 : 1])});
    }
    for (bool full : {false, true}) {
        MeshGridOptions options;
        options.resolution = 40;
        options.is_full = full;
        double told = 0;
        GridData data = sample_mesh(mesh, options, [&](double fraction) {
            told = std::max(told, fraction);
            return true;
        });
        EXPECT_GT(told, 0.5);
        for (const GridBrick& b : data.bricks)
            for (int i = 0; i < 512; ++i) {
                Vec3d q = Vec3d(b.origin) + Vec3d{static_cast<double>(i & 7), static_cast<double>(i >> 3 & 7),
                                                  static_cast<double>(i >> 6)};
                double truth = length(data.object_from_index.point(q)) - 0.75;
                ASSERT_NEAR(static_cast<double>(b.values[static_cast<std::size_t>(i)]), truth, 3e-3);
            }
        if (full) {
            EXPECT_EQ(data.bricks.size(), 6u * 6u * 6u);
        }
        VoxelField voxels(data);
        auto met = voxels.first_crossing({-5, 23.1, 22.7}, {1, 0, 0}, 100);
        ASSERT_TRUE(met);
        Vec3d p = data.object_from_index.point({-5 + *met, 23.1, 22.7});
        EXPECT_NEAR(length(p), 0.75, 2e-3);
    }
}

TEST(MeshGrids, DoNotDependOnThreads) {
    const std::vector<Corners> mesh = pebble_mesh(4);
    MeshGridOptions options;
    options.resolution = 24;
    auto with = [&](int threads) {
        GridData data;
        with_threads(threads, [&] { data = sample_mesh(mesh, options, {}); });
        return data;
    };
    GridData one = with(1), three = with(3);
    ASSERT_EQ(one.bricks.size(), three.bricks.size());
    for (std::size_t i = 0; i < one.bricks.size(); ++i) {
        EXPECT_EQ(one.bricks[i].origin, three.bricks[i].origin);
        EXPECT_EQ(one.bricks[i].values, three.bricks[i].values);
    }
}

TEST(MeshGrids, OfNothingAreAnError) {
    EXPECT_THROW(sample_mesh({}, {}, {}), std::runtime_error);
    EXPECT_THROW(sample_mesh({{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}}, {}, {}), std::runtime_error);
}

} // namespace
} // namespace alhazen
