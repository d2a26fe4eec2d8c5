/// Loop's subdivision against its own limit masks, splines and symmetries.
#include "shapes/loop_subdivision.h"
#include "shapes/triangle_mesh.h"
#include "tests/unit/shapes/support.h"

namespace alhazen {
namespace {

using namespace shape_test;
using ::testing::HasSubstr;

const std::vector<Vec3> octahedron{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
const std::vector<int> octahedron_sides{0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4,
                                        2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};

// side x side squares, each of two triangles; z by the function of (x, y).
template <class F>
LoopSurface grid(int side, F height) {
    std::vector<Vec3> p;
    std::vector<int> indices;
    for (int y = 0; y <= side; ++y)
        for (int x = 0; x <= side; ++x)
            p.push_back({static_cast<float>(x), static_cast<float>(y), height(x, y)});
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const int a = y * (side + 1) + x, b = a + 1, c = a + side + 1, d = c + 1;
            indices.insert(indices.end(), {a, b, d, a, d, c});
        }
    return {p, indices};
}
float rough(int x, int y) {
    return static_cast<float>((x * 7 + y * 13 + x * y * 5) % 11) / 11;
}

TEST(LoopSubdivision, CountsAreEulers) {
    LoopSurface s(octahedron, octahedron_sides);
    ASSERT_EQ(s.problem(), "");
    for (int level = 0; level < 5; ++level) {
        const std::size_t faces = s.indices().size() / 3;
        EXPECT_EQ(faces, std::size_t{8} << (2 * level));
        EXPECT_EQ(s.positions().size() + faces, faces * 3 / 2 + 2);
        s.refine();
    }
}

// The limit of a vertex does not depend on how often the mesh was refined before: the masks agree with the
// rules, for inner vertices of each valence.
TEST(LoopSubdivision, LimitDoesNotDependOnTheLevel) {
    auto check = [](LoopSurface s, const std::vector<std::size_t>& vertices) {
        LoopSurface direct = s;
        direct.move_to_limit();
        for (int level = 0; level < 3; ++level) {
            s.refine();
            LoopSurface later = s;
            later.move_to_limit();
            for (std::size_t i : vertices)
                EXPECT_LT(length(later.positions()[i] - direct.positions()[i]), 2e-6f) << i;
        }
    };
    check({octahedron, octahedron_sides}, {0, 1, 2, 3, 4, 5});
    check(grid(4, rough), {6, 7, 8, 11, 12, 13, 16, 17, 18});
    // A tetrahedron: valence 3. A fan around a vertex: valence 9.
    check({{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}, {0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2}},
          {0, 1, 2, 3});
    std::vector<Vec3> fan{{0, 0, 1}};
    std::vector<int> fan_indices;
    for (int i = 0; i < 9; ++i) {
        const float a = 2 * pi * static_cast<float>(i) / 9;
        fan.push_back({std::cos(a), std::sin(a), rough(i, 3)});
        fan_indices.insert(fan_indices.end(), {0, 1 + i, 1 + (i + 1) % 9});
    }
    check({fan, fan_indices}, {0});
}

// On a regular mesh the surface is a box spline, which reproduces quadratic polynomials up to a constant,
// here known from the mask: 1/2 p + 1/12 of each neighbour's.
TEST(LoopSubdivision, LimitOfAParaboloidIsAParaboloid) {
    auto square = [](int x, int) { return static_cast<float>(x * x); };
    LoopSurface s = grid(6, square);
    s.move_to_limit();
    // Of x^2, the six neighbours (of which four are a step away in x) add 4/12.
    const std::vector<Vec3> normals = s.normals();
    for (int y = 1; y < 6; ++y)
        for (int x = 1; x < 6; ++x) {
            const auto i = static_cast<std::size_t>(y * 7 + x);
            EXPECT_NEAR(s.positions()[i].z, static_cast<float>(x * x) + 1.0f / 3, 1e-5f);
            // Away from the borders, whose limits lie elsewhere. The triangles go round counter-clockwise
            // seen from +z, hence -z is outside.
            if (x < 2 || x > 4 || y < 2 || y > 4) continue;
            const Vec3 n = normalize(normals[i]),
                       expected = normalize(Vec3(2 * static_cast<float>(x), 0, -1));
            EXPECT_LT(length(n - expected), 1e-5f);
        }
}

// Boundaries are cubic B-splines of the boundary's vertices alone, whose points on the curve weigh neighbours
// by 1/6; by 1/5, as pbrt-v4 does, they are off by 1/30 of the second difference, which each level makes a
// quarter.
TEST(LoopSubdivision, BoundaryIsNearlyASpline) {
    for (int levels : {2, 4}) {
        LoopSurface s = grid(4, rough);
        for (int i = 0; i < levels; ++i) s.refine();
        s.move_to_limit();
        // Along y = 0, between the second and fourth vertex: u = 1 ... 3.
        int found = 0;
        for (const Vec3& p : s.positions()) {
            if (p.y != 0 || p.x < 1 || p.x >= 3) continue;
            const int i = static_cast<int>(p.x);
            const float u = p.x - static_cast<float>(i), v = 1 - u;
            auto z = [&](int k) { return rough(i + k, 0); };
            const float spline = (v * v * v * z(-1) + (3 * u * u * u - 6 * u * u + 4) * z(0) +
                                  (3 * v * v * v - 6 * v * v + 4) * z(1) + u * u * u * z(2)) /
                                 6;
            EXPECT_NEAR(p.z, spline, 0.07f * std::pow(0.25f, static_cast<float>(levels)));
            ++found;
        }
        EXPECT_EQ(found, 2 << levels);
    }
    // 3/5 of the vertex and 1/5 of each neighbour.
    LoopSurface s = grid(4, rough);
    s.move_to_limit();
    EXPECT_NEAR(s.positions()[2].z, 0.6f * rough(2, 0) + 0.2f * (rough(1, 0) + rough(3, 0)), 1e-6f);
}

TEST(LoopSubdivision, NormalsOfASymmetricBodyPointAlongItsAxes) {
    LoopSurface s(octahedron, octahedron_sides);
    s.refine();
    s.move_to_limit();
    const auto normals = s.normals();
    // The corners go round counter-clockwise seen from outside, so that normals point inwards.
    for (std::size_t i = 0; i < octahedron.size(); ++i)
        EXPECT_LT(length(normalize(normals[i]) + octahedron[i]), 1e-6f);
}

TEST(LoopSubdivision, NormalsAlongABoundaryAreThoseOfTheSurface) {
    // A flat patch, bent nowhere, with corners of one, two and more triangles.
    LoopSurface s =
        grid(3, [](int x, int y) { return 0.5f * static_cast<float>(x) - 0.25f * static_cast<float>(y); });
    for (int level = 0; level < 2; ++level) {
        LoopSurface limit = s;
        limit.move_to_limit();
        for (const Vec3& n : limit.normals())
            EXPECT_LT(length(normalize(n) - normalize(Vec3(0.5f, -0.25f, -1))), 1e-4f);
        s.refine();
    }
}

TEST(LoopSubdivision, ShapeHasFourTrianglesForEachAtEachLevel) {
    auto shape = make("loopsubdiv", {points(octahedron), indices(octahedron_sides)});
    EXPECT_EQ(shape->primitive_count(), 8u * 64);
    // A point that is in no triangle does no harm.
    std::vector<Vec3> more = octahedron;
    more.push_back({5, 5, 5});
    auto same = make("loopsubdiv", {points(more), indices(octahedron_sides), make_integer("levels", 0)});
    EXPECT_EQ(same->primitive_count(), 8u);
    // All of a closed surface is met twice along any line.
    Rng rng(1);
    for (int i = 0; i < 2000; ++i) {
        const Vec3 from{2 * rng.uniform() - 1, 2 * rng.uniform() - 1, -3};
        const Ray ray{from, normalize(Vec3(0.4f * rng.uniform(), 0.4f * rng.uniform(), 0) - from * 0.5f)};
        int hits = 0;
        for (std::uint32_t k = 0; k < shape->primitive_count(); ++k) {
            Intersection met;
            hits += shape->intersect(ray, k, met);
        }
        EXPECT_EQ(hits % 2, 0);
    }
}

TEST(LoopSubdivision, SaysWhatIsWrongWithTheMesh) {
    const std::vector<Vec3> p{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    auto error_of = [&](std::vector<int> i) {
        return errors_of("loopsubdiv", {points(p), indices(std::move(i))});
    };
    const std::string begin = "the control mesh cannot be subdivided: ";
    EXPECT_THAT(
        error_of({0, 1, 2, 0, 1, 3, 1, 0, 4}),
        HasSubstr(begin +
                  "the edge between vertices 0 and 1 belongs to 3 triangles; at most two are possible"));
    EXPECT_THAT(
        error_of({0, 1, 2, 0, 1, 3}),
        HasSubstr(begin +
                  "the triangles at the edge between vertices 0 and 1 go round in opposite directions"));
    EXPECT_THAT(error_of({0, 1, 2, 0, 3, 4}),
                HasSubstr(begin + "vertex 0 joins parts of the surface that have no edge in common there"));
    EXPECT_THAT(error_of({0, 1, 1}), HasSubstr(begin + "the 1st triangle has vertex 1 twice"));
    EXPECT_THAT(error_of({0, 1, 9}), HasSubstr("from 0 to 4"));
    std::vector<int> many;
    for (int i = 0; i < 9; ++i) many.insert(many.end(), {0, 1, 2});
    EXPECT_THAT(errors_of("loopsubdiv", {points(p), indices(many), make_integer("levels", 12)}),
                HasSubstr("9 triangles divided 12 times are more than 134217728; take fewer \"levels\""));
}

} // namespace
} // namespace alhazen
