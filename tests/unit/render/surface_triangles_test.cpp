/// All surfaces of a scene as triangles: which there are, where they are, and what is said of the others.
#include <algorithm>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/hash.h"
#include "base/threads.h"
#include "formats/format.h"
#include "render/surface_triangles.h"
#include "sdf/mesh_grid.h"

namespace alhazen {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::StartsWith;

struct Surfaces {
    std::vector<Corners> triangles;
    std::vector<std::string> warnings;
    std::string error;
};

Surfaces surfaces_of(const std::string& world, const SurfaceOptions& options = {},
                     const std::string& camera = "Camera \"perspective\"") {
    Messages messages;
    Surfaces s;
    try {
        const std::string text = camera + "\nWorldBegin\n" + world;
        s.triangles = surface_triangles(read_pbrt_string(text, ALHAZEN_SOURCE_DIR "/scenes", messages),
                                        options, messages);
    } catch (const SceneError& e) {
        s.error = e.what();
    }
    for (const Message& m : messages.warnings()) s.warnings.push_back(m.full_text());
    return s;
}

// A tetrahedron, its corners counter-clockwise seen from outside.
const std::string tetrahedron = R"(Shape "trianglemesh" "point3 P" [ 0 0 0  1 0 0  0 1 0  0 0 1 ]
    "integer indices" [ 0 2 1  0 1 3  0 3 2  1 2 3 ]
)";
const std::array<std::array<Vec3, 3>, 4> faces{{{{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}}},
                                                {{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}},
                                                {{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}}},
                                                {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}}};

// In an order of their own, each beginning with its least corner.
std::vector<std::array<float, 9>> sorted(const std::vector<Corners>& triangles) {
    std::vector<std::array<float, 9>> list;
    for (const Corners& t : triangles) {
        std::array<Vec3, 3> p{t.a, t.b, t.c};
        auto key = [](Vec3 v) { return std::tuple(v.x, v.y, v.z); };
        std::rotate(p.begin(),
                    std::min_element(p.begin(), p.end(), [&](Vec3 a, Vec3 b) { return key(a) < key(b); }),
                    p.end());
        list.push_back({p[0].x, p[0].y, p[0].z, p[1].x, p[1].y, p[1].z, p[2].x, p[2].y, p[2].z});
    }
    std::sort(list.begin(), list.end());
    return list;
}

// The tetrahedron scaled by a power of two and moved, which floats do without rounding; mirrored along x.
void add_tetrahedron(std::vector<Corners>& to, float scale, Vec3 move, bool mirrors = false) {
    for (const auto& face : faces) {
        auto at = [&](Vec3 p) {
            if (mirrors) p.x = -p.x;
            return p * scale + move;
        };
        const Vec3 a = at(face[0]), b = at(face[mirrors ? 2 : 1]), c = at(face[mirrors ? 1 : 2]);
        to.push_back({a, b, c});
    }
}

TEST(SurfaceTriangles, OfNestedInstancesAreWhereTheyAreSeen) {
    const Surfaces s = surfaces_of(tetrahedron + R"(
ObjectBegin "one"
AttributeBegin
Translate 2 0 0
)" + tetrahedron + R"(
AttributeEnd
ObjectEnd
ObjectBegin "two"
ObjectInstance "one"
AttributeBegin
Translate 0 4 0
Scale -2 2 2
ObjectInstance "one"
AttributeEnd
ObjectEnd
Translate 0 0 8
ObjectInstance "two"
Scale .5 .5 .5
ObjectInstance "two"
)");
    EXPECT_EQ(s.error, "");
    EXPECT_THAT(s.warnings, IsEmpty());
    std::vector<Corners> expected;
    add_tetrahedron(expected, 1, {0, 0, 0});
    add_tetrahedron(expected, 1, {2, 0, 8});
    add_tetrahedron(expected, 2, {-4, 4, 8}, true);
    add_tetrahedron(expected, 0.5f, {1, 0, 8});
    add_tetrahedron(expected, 1, {-2, 2, 8}, true);
    EXPECT_EQ(sorted(s.triangles), sorted(expected));
}

// Mirrored bodies are as solid as others; ReverseOrientation turns them inside out.
TEST(SurfaceTriangles, OutsideStaysOutside) {
    for (std::string shape : {tetrahedron, std::string("Shape \"sphere\"\n"),
                              std::string("Sdf \"b\" \"sphere\"\nShape \"sdf\" \"string field\" \"b\"\n")})
        for (std::string place : {"", "Scale -1 1 1", "Rotate 30 1 2 3", "Scale 1 -2 1"})
            for (bool is_instance : {false, true})
                for (bool reverses : {false, true}) {
                    SCOPED_TRACE(shape + place + (is_instance ? " instance" : "") +
                                 (reverses ? " reversed" : ""));
                    std::string world = place + "\n";
                    if (is_instance) world = "ObjectBegin \"a\"\n";
                    if (reverses) world += "ReverseOrientation\n";
                    world += shape;
                    if (is_instance) world += "ObjectEnd\n" + place + "\nObjectInstance \"a\"\n";
                    const Surfaces s = surfaces_of(world, {16});
                    ASSERT_EQ(s.error, "");
                    const MeshDistance mesh(s.triangles);
                    // The shape's centre of mass: a body's that is filled evenly, by the divergence theorem.
                    Vec3d centre;
                    double volume = 0;
                    for (const Corners& t : s.triangles) {
                        const double v = dot(Vec3d(t.a), cross(Vec3d(t.b), Vec3d(t.c))) / 6;
                        centre += (Vec3d(t.a) + Vec3d(t.b) + Vec3d(t.c)) * (v / 4);
                        volume += v;
                    }
                    EXPECT_NEAR(mesh.winding_number(centre * (1 / volume)), reverses ? -1 : 1, 0.05);
                }
}

TEST(SurfaceTriangles, OfBallsAreWithinASixteenthOfACell) {
    // Made larger only where it is placed.
    const Surfaces s = surfaces_of(R"(ObjectBegin "ball"
Shape "sphere" "float radius" .5
ObjectEnd
Scale 10 10 10
ObjectInstance "ball"
)",
                                   {64});
    ASSERT_EQ(s.error, "");
    const double cell = 10.0 / 64;
    const GridData grid = sample_mesh(s.triangles, {64, 3, true}, {});
    double farthest = 0;
    for (const GridBrick& b : grid.bricks)
        for (int i = 0; i < 512; ++i) {
            const Vec3d at = Vec3d(b.origin + Vec3i{i & 7, i >> 3 & 7, i >> 6});
            const double exact = length(grid.object_from_index.point(at)) - 5;
            farthest = std::max(farthest,
                                std::abs(static_cast<double>(b.values[static_cast<std::size_t>(i)]) - exact));
        }
    EXPECT_LE(farthest, cell / 16);
    EXPECT_GE(farthest, cell / 200); // or it is finer than needed
}

TEST(SurfaceTriangles, OfPatchesAreTwoWhereFlatAndMoreWhereTwisted) {
    const std::string flat = "Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0  2 0 0  0 1 0  1 1 0 ]\n";
    EXPECT_EQ(surfaces_of(flat).triangles.size(), 2u);
    const Surfaces s =
        surfaces_of("Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0  1 0 0  0 1 0  1 1 1 ]\n", {16});
    // z = x y, of which a sixteenth of a cell of 1/16 is 1/256; n x n pieces are off by 1 / (4 n^2).
    EXPECT_EQ(s.triangles.size(), 2u * 8 * 8);
    for (const Corners& t : s.triangles) {
        const Vec3 middle = (t.a + t.b + t.c) / 3;
        EXPECT_NEAR(middle.z, middle.x * middle.y, 1.0f / 256);
    }
}

TEST(SurfaceTriangles, BordersOfMediaAreLeftOutAndLightsAreNot) {
    const Surfaces s = surfaces_of(R"(MakeNamedMedium "fog" "string type" "homogeneous"
LightSource "infinite"
AttributeBegin
MediumInterface "fog" ""
Material "interface"
Shape "sphere" "float radius" 100
AttributeEnd
AttributeBegin
AreaLightSource "diffuse"
)" + tetrahedron + "AttributeEnd\n");
    EXPECT_EQ(s.error, "");
    EXPECT_THAT(s.warnings, IsEmpty());
    EXPECT_EQ(s.triangles.size(), 4u);
}

TEST(SurfaceTriangles, WhatCannotBeCutIsNamed) {
    const std::string strand = "Shape \"curve\" \"point3 P\" [ 0 0 0  1 0 0  2 0 0  3 0 0 ]\n";
    const Surfaces s = surfaces_of(strand + tetrahedron + strand);
    EXPECT_EQ(s.error, "");
    EXPECT_EQ(s.triangles.size(), 4u);
    EXPECT_THAT(s.warnings,
                ElementsAre("<string>:3:1: warning: shape \"curve\" cannot be cut into triangles; it is "
                            "left out (and 1 more like this)"));
}

TEST(SurfaceTriangles, EmptyScenesAreErrors) {
    EXPECT_EQ(surfaces_of("").error, "error: the scene has no surfaces");
    EXPECT_EQ(surfaces_of("Material \"interface\"\nShape \"sphere\"\n").error,
              "error: the scene has no surfaces");
    EXPECT_EQ(surfaces_of("Shape \"curve\" \"point3 P\" [ 0 0 0  1 0 0  2 0 0  3 0 0 ]\n").error,
              "<string>:3:1: warning: shape \"curve\" cannot be cut into triangles; it is left out\n"
              "error: the scene has no surfaces that can be cut into triangles");
    EXPECT_THAT(surfaces_of("Shape \"cube\"\n").error,
                StartsWith("<string>:3:1: error: unknown shape \"cube\""));
}

// Nested eight deep, a hundred each: nothing is expanded to find out.
TEST(SurfaceTriangles, TooManyInstancesAreAnError) {
    std::string world = "ObjectBegin \"0\"\n" + tetrahedron + "ObjectEnd\n";
    for (int i = 1; i < 8; ++i) {
        world += "ObjectBegin \"" + std::to_string(i) + "\"\n";
        for (int k = 0; k < 100; ++k)
            world += "Translate 1 0 0\nObjectInstance \"" + std::to_string(i - 1) + "\"\n";
        world += "ObjectEnd\n";
    }
    EXPECT_EQ(surfaces_of(world + "ObjectInstance \"7\"\n").error,
              "error: the scene's surfaces would be 400000000000000 triangles, instances repeated; at most "
              "33554432 are made (--max-triangles)");
    const std::string few = world + "ObjectInstance \"1\"\n";
    EXPECT_EQ(surfaces_of(few, {128, 399}).error,
              "error: the scene's surfaces would be 400 triangles, instances repeated; at most 399 are made "
              "(--max-triangles)");
    EXPECT_EQ(surfaces_of(few, {128, 400}).triangles.size(), 400u);
}

TEST(SurfaceTriangles, WhatMovesIsTakenAtTheShuttersOpening) {
    const std::string move = R"(ObjectBegin "a"
)" + tetrahedron + R"(ObjectEnd
ActiveTransform EndTime
Translate 8 0 0
ActiveTransform All
ObjectInstance "a"
)" + tetrahedron;
    const Surfaces s = surfaces_of(move, {}, "Camera \"perspective\" \"float shutteropen\" .25");
    EXPECT_EQ(s.error, "");
    EXPECT_THAT(s.warnings,
                ElementsAre("<string>:10:1: warning: what moves is taken where it is when the shutter "
                            "opens (and 1 more like this)"));
    std::vector<Corners> expected;
    add_tetrahedron(expected, 1, {2, 0, 0});
    add_tetrahedron(expected, 1, {2, 0, 0});
    EXPECT_EQ(sorted(s.triangles), sorted(expected));
}

TEST(SurfaceTriangles, DoNotDependOnThreads) {
    const std::string world = tetrahedron + R"(Shape "sphere"
Sdf "b" "torus"
Shape "sdf" "string field" "b"
Shape "cylinder"
)";
    std::vector<std::vector<Corners>> all;
    for (int threads : {1, 4})
        with_threads(threads, [&] { all.push_back(surfaces_of(world, {32}).triangles); });
    ASSERT_EQ(all[0].size(), all[1].size());
    EXPECT_EQ(std::memcmp(all[0].data(), all[1].data(), all[0].size() * sizeof(Corners)), 0);
}

} // namespace
} // namespace alhazen
