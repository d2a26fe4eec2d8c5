/// What of a mesh is solid: bodies, also with holes, but not the ground that they stand on.
#include <limits>

#include <gtest/gtest.h>

#include "sdf/mesh_grid.h"
#include "sdf/solid_parts.h"

namespace alhazen {
namespace {

using Mesh = std::vector<Corners>;

Mesh joined(std::initializer_list<Mesh> parts) {
    Mesh all;
    for (const Mesh& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

// Two triangles, facing cross(b - a, d - a).
Mesh quad(Vec3 a, Vec3 b, Vec3 d) {
    const Vec3 c = b + d - a;
    return {{a, b, c}, {a, c, d}};
}

// Faces of a cube with half side 1, moved outward by gap.
Mesh cube(Vec3 centre, float gap = 0, int faces = 6) {
    Mesh mesh;
    for (int i = 0; i < faces; ++i) {
        const int axis = i % 3;
        Vec3 n, u, v;
        n[axis] = i < 3 ? 1.0f : -1.0f;
        u[(axis + 1) % 3] = n[axis];
        v[(axis + 2) % 3] = 1;
        const Vec3 middle = centre + n * (1 + gap);
        for (const Corners& t : quad(middle - u - v, middle + u - v, middle - u + v)) mesh.push_back(t);
    }
    return mesh;
}

Mesh floor_and_wall() {
    return joined({quad({-20, -1.5f, -20}, {-20, -1.5f, 20}, {20, -1.5f, -20}),
                   quad({-20, -1.5f, 20}, {-20, 30, 20}, {20, -1.5f, 20})});
}

void expect_same(const Mesh& a, const Mesh& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].a, b[i].a);
        EXPECT_EQ(a[i].b, b[i].b);
        EXPECT_EQ(a[i].c, b[i].c);
    }
}

TEST(SolidParts, AreBodiesAndNotTheGround) {
    const Mesh first = cube({-4, 0, 0}), second = cube({3, 0, 1}), lidless = cube({0, 5, 0}, 0, 5);
    const MeshParts parts = mesh_parts(joined({first, floor_and_wall(), second, lidless}), true);
    expect_same(parts.solid, joined({first, second, lidless}));
    expect_same(parts.sheets, floor_and_wall());
    expect_same(mesh_parts(first, true).solid, first);
}

// In a scene they might as well be the walls of a room, so that they are sheets.
TEST(SolidParts, OfOneBodyAreFacesThatDoNotQuiteMeet) {
    const Mesh loose = cube({}, 0.01f), body = cube({5, 0, 0});
    expect_same(mesh_parts(joined({loose, body}), true).solid, joined({loose, body}));
    expect_same(mesh_parts(joined({loose, body}), false).sheets, loose);
    const Mesh three_faces = cube({}, 0.01f, 3);
    expect_same(mesh_parts(three_faces, true).sheets, three_faces);
}

TEST(SolidParts, MayBeNothing) {
    EXPECT_TRUE(mesh_parts(Mesh{}, true).solid.empty());
    Mesh broken = cube({});
    broken[3].b.y = std::numeric_limits<float>::quiet_NaN();
    const MeshParts parts = mesh_parts(broken, true);
    EXPECT_EQ(parts.solid.size() + parts.sheets.size(), broken.size());
    Mesh broken_ground = floor_and_wall();
    broken_ground[1].c.x = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(mesh_parts(broken_ground, true).sheets.size(), 4u);
}

// The corner of floor and wall fills up to three quarters of all directions.
TEST(SheetsInGrids, AreWallsAndDoNotTurnBodiesInsideOut) {
    for (bool is_one_body : {false, true}) {
        const GridData grid =
            sample_mesh(joined({cube({2, 0, 3}), floor_and_wall()}), {80, 3, true, is_one_body}, {});
        const double cell = 0.5;
        int inside = 0;
        for (const GridBrick& b : grid.bricks)
            for (int i = 0; i < 512; ++i) {
                const Vec3d p =
                    grid.object_from_index.point(Vec3d(b.origin + Vec3i{i & 7, i >> 3 & 7, i >> 6}));
                const double body = max_component(abs(p - Vec3d{2, 0, 3})) - 1;
                const double ground = length(p - min(max(p, Vec3d{-20, -1.5, -20}), Vec3d{20, -1.5, 20}));
                const double wall = length(p - min(max(p, Vec3d{-20, -1.5, 20}), Vec3d{20, 30, 20}));
                const double expected = std::min(body, std::min(ground, wall) - 0.75 * cell);
                if (std::abs(expected) < 1e-3) continue;
                const float value = b.values[static_cast<std::size_t>(i)];
                ASSERT_EQ(value < 0, expected < 0) << p.x << " " << p.y << " " << p.z;
                if (expected < body) {
                    ASSERT_NEAR(static_cast<double>(value), expected, 1e-4);
                }
                inside += body < -1e-3;
            }
        EXPECT_EQ(inside, 27); // of cells half as large as its half side
    }
}

} // namespace
} // namespace alhazen
