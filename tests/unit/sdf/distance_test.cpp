/// Distances of primitives against the nearest of many points on their surfaces, and messages of trees that
/// cannot be built.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/hash.h"
#include "sdf/tessellate.h"
#include "tests/support/sdf_world.h"

namespace alhazen {
namespace {

using namespace testing_support;
using ::testing::HasSubstr;

Vec3d random_in(const Box& box, Rng& rng) {
    Vec3d p = box.lo, size = box.size();
    for (int i = 0; i < 3; ++i) p[i] += size[i] * static_cast<double>(rng.uniform());
    return p;
}

Vec3d nearest_on(const SdfTriangle& t, Vec3d p) {
    // By halving: the nearest of the corners and midpoints, around which a smaller triangle is tried next.
    SdfTriangle at = t;
    Vec3d best = t[0];
    for (int level = 0; level < 12; ++level) {
        std::array<Vec3d, 6> q{
            at[0], at[1], at[2], (at[0] + at[1]) * 0.5, (at[1] + at[2]) * 0.5, (at[2] + at[0]) * 0.5};
        std::size_t nearest = 0;
        for (std::size_t i = 1; i < 6; ++i)
            if (length(q[i] - p) < length(q[nearest] - p)) nearest = i;
        best = q[nearest];
        static constexpr std::size_t parts[6][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2},
                                                    {0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
        Vec3d centre = (q[3] + q[4] + q[5]) * (1.0 / 3);
        if (nearest >= 3 &&
            length(centre - p) <
                length((q[parts[nearest][0]] + q[parts[nearest][1]] + q[parts[nearest][2]]) * (1.0 / 3) - p))
            at = {q[3], q[4], q[5]};
        else
            at = {q[parts[nearest][0]], q[parts[nearest][1]], q[parts[nearest][2]]};
    }
    return best;
}

// The field is the distance itself: the nearest point of the surface, found among all its triangles and
// without the field's help, is as far away as the field says.
TEST(SdfDistances, AreThoseOfTheNearestPointOfTheSurface) {
    struct Exact {
        std::string kind;
        std::vector<Parameter> parameters;
    };
    const Exact primitives[] = {
        {"sphere", {make_float("radius", 0.7f)}},
        {"box", {make_point3("size", {2, 1, 0.5f})}},
        {"roundedbox", {make_point3("size", {2, 1.5f, 1}), make_float("radius", 0.3f)}},
        {"torus", {make_float("radius", 1), make_float("tube", 0.3f)}},
        {"cylinder", {make_float("radius", 0.8f), make_float("height", 1.5f)}},
        {"capsule",
         {make_point3("p0", {-0.5f, 0, 0.25f}), make_point3("p1", {0.75f, 0.5f, 0}),
          make_float("radius", 0.3f)}},
        {"cone", {make_float("radius", 1), make_float("height", 1.5f)}},
        {"cone", {make_float("radius", 0.5f), make_float("topradius", 1), make_float("height", 1.25f)}},
        {"ellipsoid", {make_point3("radii", {0.5f, 0.75f, 1.25f})}},
        {"ellipsoid", {make_point3("radii", {1, 1, 0.25f})}},
        {"octahedron", {make_float("radius", 1)}},
    };
    for (const Exact& e : primitives) {
        SCOPED_TRACE(e.kind);
        SdfSet set = make_sdfs({sdf_node("it", e.kind, e.parameters)});
        auto field = set.find("it");
        std::vector<SdfTriangle> triangles = tessellate(*field, 5);
        Rng rng(1);
        // Edges are cut by up to a cell of a 32nd, curves by far less.
        double cell = max_component(field->bounds().size()) / 32;
        for (int i = 0; i < 60; ++i) {
            Vec3d p = random_in(field->bounds().grown(0.5), rng);
            double least = Box::far;
            for (const SdfTriangle& t : triangles) {
                if (length(t[0] - p) > least + 3 * cell) continue;
                least = std::min(least, length(nearest_on(t, p) - p));
            }
            ASSERT_NEAR(std::abs(field->value(p)), least, 0.75 * cell);
            // A sampled point is never nearer than the surface.
            ASSERT_LE(std::abs(field->value(p)), least + 0.05 * cell * cell + 0.3 * cell);
        }
    }
}

// The same to ten digits where the nearest point is known in closed form or by dense search in one variable.
TEST(SdfDistances, OfAnEllipsoidSatisfyTheNormalEquation) {
    SdfSet set = make_sdfs({sdf_node("egg", "ellipsoid", {make_point3("radii", {0.5f, 0.75f, 1.25f})})});
    auto egg = set.find("egg");
    Rng rng(2);
    for (int i = 0; i < 2000; ++i) {
        Vec3d p = random_in(egg->bounds().grown(1), rng);
        if (i % 10 == 0) p.x = 0;
        if (i % 15 == 0) p.y = 0;
        Dual f = egg->value(dual_point(p));
        Vec3d q = p - f.d * f.v; // the foot of the perpendicular
        double on = q.x * q.x / 0.25 + q.y * q.y / 0.5625 + q.z * q.z / 1.5625;
        ASSERT_NEAR(on, 1, 1e-10);
        Vec3d n = normalize(Vec3d{q.x / 0.25, q.y / 0.5625, q.z / 1.5625});
        ASSERT_NEAR(length(n - f.d), 0, 1e-9);
        // No other foot is nearer.
        for (int k = 0; k < 20; ++k) {
            Vec3d d = random_in(Box::around(Vec3d(1.0)), rng);
            Vec3d other = d * (1 / std::sqrt(d.x * d.x / 0.25 + d.y * d.y / 0.5625 + d.z * d.z / 1.5625));
            ASSERT_GE(length(other - p), std::abs(f.v) - 1e-10);
        }
    }
}

// Where points lie on flat and slanted sides to the last bit, the normal is that of the side.
TEST(SdfDistances, HaveNormalsOnTheSurfaceItself) {
    SdfSet set =
        make_sdfs({sdf_node("bucket", "cone", {make_float("radius", 0.5f), make_float("topradius", 1)}),
                   sdf_node("tube", "cylinder", {}), sdf_node("cube", "box", {})});
    for (const char* name : {"bucket", "tube", "cube"})
        for (double z : {-1.0, 1.0})
            for (const Vec3d& p : {Vec3d{0.1, 0.2, z}, Vec3d{0, 0, z}, Vec3d{-0.3, 0, z}}) {
                const Dual f = set.find(name)->value(dual_point(p));
                EXPECT_EQ(f.v, 0) << name;
                EXPECT_EQ(f.d, (Vec3d{0, 0, z})) << name;
            }
    // Halfway up the slanted side, which runs from (0.5, -1) to (1, 1).
    const Dual f = set.find("bucket")->value(dual_point(Vec3d{0.75, 0, 0}));
    EXPECT_NEAR(f.v, 0, 1e-15);
    EXPECT_NEAR(length(f.d - normalize(Vec3d{2, 0, -0.5})), 0, 1e-12);
}

TEST(SdfOperators, SmoothUnionsAreAQuarterOfTheSeamLower) {
    SdfSet set = make_sdfs(
        {sdf_node("a", "sphere", {}, Matrix4::translate({-1, 0, 0})),
         sdf_node("b", "sphere", {}, Matrix4::translate({1, 0, 0})),
         sdf_node("sharp", "union", {names("children", {"a", "b"})}),
         sdf_node("soft", "union", {names("children", {"a", "b"}), make_float("smooth", 0.4f)}),
         sdf_node("lens", "intersection", {names("children", {"a", "b"}), make_float("smooth", 0.4f)}),
         sdf_node("bite", "difference", {names("children", {"a", "b"})})});
    Vec3d middle{0, 0.5, 0};
    double f = set.find("a")->value(middle);
    EXPECT_DOUBLE_EQ(set.find("sharp")->value(middle), f);
    EXPECT_NEAR(set.find("soft")->value(middle), f - 0.1, 1e-8);
    EXPECT_NEAR(set.find("lens")->value(middle), f + 0.1, 1e-8);
    EXPECT_DOUBLE_EQ(set.find("bite")->value(Vec3d{0.5, 0, 0}), 0.5);
    EXPECT_NEAR(set.find("bite")->value(Vec3d{-1.5, 0, 0}), -0.5, 1e-12);
}

TEST(SdfOperators, ShellOffsetRepeatAndMirror) {
    SdfSet set = make_sdfs(
        {sdf_node("ball", "sphere", {make_float("radius", 0.5f)}),
         sdf_node("hollow", "shell", {make_string("child", "ball"), make_float("thickness", 0.25f)}),
         sdf_node("fat", "offset", {make_string("child", "ball"), make_float("distance", 0.25f)}),
         sdf_node("row", "repeat",
                  {make_string("child", "ball"), make_point3("spacing", {2, 2, 2}),
                   make_point3("count", {3, 1, 0})}),
         sdf_node("aside", "sphere", {make_float("radius", 0.5f)}, Matrix4::translate({1, 0, 0})),
         sdf_node("pair", "mirror", {make_string("child", "aside")})});
    EXPECT_DOUBLE_EQ(set.find("hollow")->value(Vec3d{0, 0, 0}), 0.375);
    EXPECT_DOUBLE_EQ(set.find("hollow")->value(Vec3d{0, 0.5, 0}), -0.125);
    EXPECT_DOUBLE_EQ(set.find("fat")->value(Vec3d{0, 1, 0}), 0.25);
    auto row = set.find("row");
    EXPECT_DOUBLE_EQ(row->value(Vec3d{2, 0, 1000}), -0.5);
    EXPECT_NEAR(row->value(Vec3d{4, 0, 0}), 1.5, 1e-12); // there is no fourth
    EXPECT_NEAR(row->value(Vec3d{0, 2, 0}), 1.5, 1e-12);
    EXPECT_NEAR(set.find("pair")->value(Vec3d{-1, 0, 0}), -0.5, 1e-12);
}

TEST(SdfOperators, LeastStretchIsTheSmallestSingularValue) {
    Rng rng(3);
    for (int i = 0; i < 200; ++i) {
        auto number = [&] { return 2 * static_cast<double>(rng.uniform()) - 1; };
        Matrix4 m = Matrix4::rotate(180 * number(), {number(), number(), 1}) *
                    Matrix4::scale({3, -0.25 - static_cast<double>(rng.uniform()), 2}) *
                    Matrix4::rotate(180 * number(), {1, number(), number()});
        double least = least_stretch(m), found = Box::far;
        for (int k = 0; k < 3000; ++k) {
            Vec3d d = random_in(Box::around(Vec3d(1.0)), rng);
            found = std::min(found, length(m.vector(d)) / length(d));
        }
        ASSERT_LE(least, found);
        ASSERT_GT(least, 0.85 * found);
    }
}

std::string errors_of(const std::vector<TextureNode>& nodes) {
    SdfSet set;
    Messages messages;
    BuildContext context{.messages = messages};
    set.build(nodes, context);
    std::string text;
    for (const Message& m : messages.list()) text += m.full_text() + "\n";
    return text;
}

TEST(SdfMessages, SayWhatIsWrong) {
    auto ball = sdf_node("ball", "sphere", {});
    EXPECT_THAT(errors_of({ball, sdf_node("u", "union", {names("children", {"ball", "bal"})})}),
                HasSubstr("no sdf \"bal\" is defined before this (did you mean \"ball\"?)"));
    EXPECT_THAT(errors_of({sdf_node("s", "spere", {})}), HasSubstr("sphere"));
    EXPECT_THAT(errors_of({sdf_node("s", "sphere", {make_float("radios", 1)})}), HasSubstr("radius"));
    EXPECT_THAT(errors_of({ball, sdf_node("s", "shell", {})}), HasSubstr("child"));
    EXPECT_THAT(errors_of({sdf_node("p", "plane", {}), sdf_node("t", "twist", {make_string("child", "p")})}),
                HasSubstr("needs a child that ends somewhere"));
    EXPECT_THAT(
        errors_of({ball, sdf_node("r", "repeat",
                                  {make_string("child", "ball"), make_point3("spacing", {1, 1, 1})})}),
        HasSubstr("it must stay within 0.5 of the origin"));
    EXPECT_THAT(
        errors_of({ball, sdf_node("m", "mirror", {make_string("child", "ball"), make_string("axes", "w")})}),
        HasSubstr("expected some of the letters"));
    EXPECT_THAT(errors_of({sdf_node("b", "box", {make_point3("size", {1, 0, 1})})}),
                HasSubstr("greater than 0"));
    EXPECT_THAT(errors_of({ball, ball}), HasSubstr("already defined"));
}

} // namespace
} // namespace alhazen
