/// Triangles that stand for shapes: near the surface, all over it, and the right way round; for each example
/// of each registered kind.
#include <gtest/gtest.h>

#include "sdf/mesh_distance.h"
#include "shapes/triangle_mesh.h"
#include "tests/conformance/shape_cases.h"
#include "tests/support/effort.h"

namespace alhazen {
namespace {

using namespace shape_cases;

bool is_field(const ShapeCase& c) {
    return c.kind == "sdf" || c.kind == "sdfgrid";
}

std::vector<Corners> triangles_of(const ShapeCase& c, double tolerance) {
    std::vector<Corners> triangles;
    const bool is_cut = c.shape->tessellate(tolerance, [&](const Corners& t) { triangles.push_back(t); });
    EXPECT_EQ(is_cut, c.kind != "curve") << c.name;
    EXPECT_EQ(is_cut, !triangles.empty()) << c.name;
    return triangles;
}

Vec3d area_of(const Corners& t) {
    return cross(Vec3d(t.b) - Vec3d(t.a), Vec3d(t.c) - Vec3d(t.a)) * 0.5;
}

// Seen from outside by the parameterisation, whichever way the world's normals point.
double side_of(const ShapeCase& c, Vec3 ng) {
    const bool mirrors = c.world_from_object.swaps_handedness();
    const bool is_equation = !c.shape->triangles() && c.kind != "bilinearmesh" && c.kind != "plymesh";
    return (is_equation && mirrors ? -1 : 1) * static_cast<double>(dot(ng, ng));
}

TEST(Tessellations, AreTheSurface) {
    for (const ShapeCase& c : all_cases()) {
        SCOPED_TRACE(c.name);
        const double tolerance = static_cast<double>(c.size()) / 400;
        const std::vector<Corners> triangles = triangles_of(c, tolerance);
        if (triangles.empty()) continue;
        double area = 0, exact = 0;
        for (const Corners& t : triangles) area += length(area_of(t));
        for (std::uint32_t i = 0; i < c.shape->primitive_count(); ++i)
            exact += static_cast<double>(c.shape->area(i));
        EXPECT_NEAR(area, exact, (is_field(c) ? 0.04 : 0.01) * exact);

        const MeshDistance mesh(triangles);
        // What fields have of edges is cut off by a cell.
        const double farthest = is_field(c) ? 8 * tolerance : tolerance;
        const bool has_normals = c.node.find("N") || c.kind == "loopsubdiv";
        Rng rng(7);
        int turned = 0, count = 0;
        for (int i = 0; i < testing_support::fewer_if_sanitized(300); ++i) {
            const auto primitive =
                static_cast<std::uint32_t>(rng.uniform() * static_cast<float>(c.shape->primitive_count()));
            const ShapeSample s = c.shape->sample(primitive, {rng.uniform(), rng.uniform()});
            if (!(s.pdf > 0)) continue;
            const auto near = mesh.nearest(Vec3d(s.p), 1e30);
            ASSERT_TRUE(near);
            ASSERT_LE(near->distance, farthest * 1.001);
            if (has_normals) continue;
            const Vec3d n = area_of(triangles[near->triangle]);
            turned += dot(n, Vec3d(s.ng)) * side_of(c, s.ng) < 0;
            ++count;
        }
        // Next to edges the nearest triangle may be on the other side.
        EXPECT_LE(turned, is_field(c) ? count / 20 : 0);
    }
}

// The finer, the nearer, by the square of the size of triangles.
TEST(Tessellations, OfCurvedSurfacesAreAsFineAsTheyMustBe) {
    for (const ShapeCase& c : all_cases()) {
        if (c.kind != "sphere" && c.kind != "bilinearmesh") continue;
        SCOPED_TRACE(c.name);
        const auto size = static_cast<double>(c.size());
        const std::size_t coarse = triangles_of(c, size / 100).size();
        const std::size_t fine = triangles_of(c, size / 10000).size();
        if (c.kind == "sphere" || c.example == "saddle") {
            EXPECT_GT(fine, 50 * coarse);
            EXPECT_LT(fine, 150 * coarse);
        } else {
            EXPECT_EQ(coarse, fine); // flat
        }
    }
}

} // namespace
} // namespace alhazen
