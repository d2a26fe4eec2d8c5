#include <cmath>
#include <map>

#include "accel/accel.h"
#include "base/hash.h"
#include "shapes/bilinear_mesh.h"
#include "shapes/spherical_triangle.h"
#include "shapes/triangle_mesh.h"
#include "tests/unit/shapes/support.h"

namespace alhazen {
namespace {

using namespace shape_test;
using testing::HasSubstr;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

// A mesh as acceleration structures see it.
class MeshPrimitives final : public Primitives {
  public:
    explicit MeshPrimitives(const TriangleMesh& mesh) : mesh_(mesh) {}
    std::uint32_t count() const override { return mesh_.primitive_count(); }
    PrimitiveKind kind(std::uint32_t) const override { return PrimitiveKind::triangle; }
    Bounds3 bounds(std::uint32_t i) const override { return mesh_.bounds(i); }
    Corners corners(std::uint32_t i) const override {
        auto [a, b, c] = mesh_.vertices(i);
        return {a, b, c};
    }

  private:
    const TriangleMesh& mesh_;
};

TEST(TriangleMesh, TakesThreeVerticesWithoutIndices) {
    auto mesh = make("trianglemesh", {points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})});
    ASSERT_EQ(mesh->primitive_count(), 1u);
    Hit h = hit(*mesh, {{0.25f, 0.25f, 3}, {0, 0, -1}});
    EXPECT_EQ(h.ng.z, 1);
    EXPECT_EQ(h.t, 3);
    // pbrt's parameters without uv: (0,0), (1,0), (1,1).
    EXPECT_FLOAT_EQ(h.uv.x, 0.5f);
    EXPECT_FLOAT_EQ(h.uv.y, 0.25f);
    EXPECT_FLOAT_EQ(mesh->area(0), 0.5f);
    EXPECT_NE(mesh->triangles(), nullptr);
    EXPECT_EQ(make("sphere", {})->triangles(), nullptr);
}

TEST(Shapes, SayHowMuchMemoryTheyTake) {
    auto triangle = points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    auto normals = make_array("N", ValueType::normal, std::vector<Vec3>(3, Vec3{0, 0, 1}));
    const std::size_t plain = make("trianglemesh", {triangle})->bytes();
    EXPECT_GE(plain, sizeof(TriangleMesh) + 3 * sizeof(Vec3) + 3 * sizeof(int));
    EXPECT_EQ(make("trianglemesh", {triangle, normals})->bytes(), plain + 3 * sizeof(Vec3));
    auto patch = make("bilinearmesh", {points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}})});
    EXPECT_GE(patch->bytes(), sizeof(BilinearMesh) + 4 * sizeof(Vec3) + 4 * sizeof(int));
    EXPECT_GE(make("sphere", {})->bytes(), sizeof(Shape) + 2 * sizeof(Matrix4));
}

TEST(TriangleMesh, OrientationIsPbrts) {
    auto triangle = points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    Ray ray{{0.25f, 0.25f, 3}, {0, 0, -1}};
    EXPECT_EQ(hit(*make("trianglemesh", {triangle}, {.reverse = true}), ray).ng.z, -1);
    // Mirrored: the winding turns over, and the orientation turns it back.
    Ray left{{-0.25f, 0.25f, 3}, {0, 0, -1}};
    Matrix4 mirror = Matrix4::scale({-1, 1, 1});
    EXPECT_EQ(hit(*make("trianglemesh", {triangle}, {.world_from_object = mirror}), left).ng.z, 1);
    // Vertex normals decide, and are turned over themselves.
    auto normals = make_array("N", ValueType::normal, std::vector<Vec3>(3, Vec3{0, 0.6f, -0.8f}));
    Hit h = hit(*make("trianglemesh", {triangle, normals}), ray);
    EXPECT_EQ(h.ng.z, -1);
    EXPECT_FLOAT_EQ(h.ns.z, -0.8f);
    EXPECT_EQ(hit(*make("trianglemesh", {triangle, normals}, {.reverse = true}), ray).ng.z, 1);
    EXPECT_EQ(make("trianglemesh", {triangle, normals})->normals(0).axis.z, -1);
}

TEST(TriangleMesh, TangentsFollowS) {
    auto mesh =
        make("trianglemesh", {points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}),
                              make_array("S", ValueType::vector3, std::vector<Vec3>(3, Vec3{0, 2, 1}))});
    Hit h = hit(*mesh, {{0.25f, 0.25f, 3}, {0, 0, -1}});
    EXPECT_NEAR(h.dpdu.x, 0, 1e-6);
    EXPECT_FLOAT_EQ(h.dpdu.y, 2);
    EXPECT_NEAR(h.dpdu.z, 0, 1e-6);
}

TEST(TriangleMesh, VertexNormalsLeaveTheParametersScalesAndAngles) {
    // p = (2 u + v, v / 4, 0) and the mirrored parameters: their tangents are neither as long as each other
    // nor square.
    const std::vector<Vec2> uv{{0, 0}, {0.5f, 0}, {-2, 4}};
    for (const float side : {1.0f, -1.0f}) {
        SCOPED_TRACE(side);
        std::vector<Vec2> parameters = uv;
        for (Vec2& p : parameters) p.x *= side;
        for (const Vec3& n : {Vec3(0, 0, 1), normalize(Vec3(0.3f, -0.2f, 1))}) {
            auto mesh = make("trianglemesh", {points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}),
                                              make_array("uv", ValueType::point2, parameters),
                                              make_array("N", ValueType::normal, std::vector<Vec3>(3, n))});
            const Hit h = hit(*mesh, {{0.25f, 0.25f, 3}, {0, 0, -1}});
            // Tangents of the shading surface: less what stands along its normal.
            auto across = [&](Vec3 t) { return t - n * dot(n, t); };
            EXPECT_LT(length(h.dpdu - across({2 * side, 0, 0})), 1e-6f);
            EXPECT_LT(length(h.dpdv - across({1, 0.25f, 0})), 1e-6f);
        }
    }
}

TEST(TriangleMesh, DegenerateTrianglesAreNeverHit) {
    auto mesh =
        make("trianglemesh", {points({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {0.1f, 0.1f, 0.1f}, {0.3f, 0.1f, 0}}),
                              indices({0, 1, 2, 3, 3, 4, 0, 0, 0, 0, 2, 1})});
    Rng rng(2);
    for (int i = 0; i < 20000; ++i) {
        Vec3 o{4 * rng.uniform() - 1, 4 * rng.uniform() - 1, -2}, on = Vec3(2 * rng.uniform());
        Intersection met;
        for (std::uint32_t k = 0; k < 4; ++k) ASSERT_FALSE(mesh->intersect({o, on - o}, k, met));
    }
    EXPECT_EQ(mesh->area(0), 0);
}

TEST(TriangleMesh, RaysNearItsPlaneKnowTheirSide) {
    // A wide floor: a ray may start just above it and must still see it.
    auto mesh = make("trianglemesh", {points({{-1000, -1000, 1}, {1000, -1000, 1}, {0, 1500, 1}})});
    Intersection met;
    EXPECT_TRUE(mesh->intersect({{3, 4, next_up(1.0f)}, {0.3f, 0.2f, -1}}, 0, met));
    EXPECT_FALSE(mesh->intersect({{3, 4, next_up(1.0f)}, {0.3f, 0.2f, 1}}, 0, met));
    EXPECT_FALSE(mesh->intersect({{3, 4, 1}, {0.3f, 0.2f, 1}}, 0, met));
    EXPECT_FALSE(mesh->intersect({{3, 4, next_down(1.0f)}, {0.3f, 0.2f, -1}}, 0, met));
}

TEST(TriangleMesh, SaysWhatIsWrong) {
    auto square = points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}});
    EXPECT_THAT(errors_of("trianglemesh", {}), HasSubstr("needs the parameter"));
    EXPECT_THAT(errors_of("trianglemesh", {points({})}), HasSubstr("there are no vertices"));
    EXPECT_THAT(errors_of("trianglemesh", {square}), HasSubstr("there are no triangles"));
    EXPECT_THAT(
        errors_of("trianglemesh", {square, indices({0, 1, 4})}),
        HasSubstr("the 3rd value of \"indices\" is 4; it must be from 0 to 3, as there are 4 vertices"));
    EXPECT_THAT(errors_of("trianglemesh", {square, indices({0, -1, 2})}),
                HasSubstr("the 2nd value of \"indices\" is -1"));
    EXPECT_THAT(errors_of("trianglemesh", {square, indices({0, 1, 2, 3})}),
                HasSubstr("\"indices\" has 4 values; it must have 3 for each triangle"));
    for (const char* name : {"N", "S"})
        EXPECT_THAT(
            errors_of("trianglemesh", {square, indices({0, 1, 2}),
                                       make_array(name, ValueType::normal, std::vector<Vec3>{{0, 0, 1}})}),
            HasSubstr(std::string("\"") + name + "\" has 1 values for 4 vertices"));
    EXPECT_THAT(errors_of("trianglemesh", {square, indices({0, 1, 2}),
                                           make_array("uv", ValueType::point2, std::vector<Vec2>(5))}),
                HasSubstr("\"uv\" has 5 values for 4 vertices"));
    EXPECT_THAT(
        errors_of("trianglemesh", {square, indices({0, 1, 2}),
                                   make_array("faceIndices", ValueType::integer, std::vector<int>{1, 2})}),
        HasSubstr("\"faceIndices\" has 2 values for 1 triangles"));
    EXPECT_THAT(errors_of("trianglemesh", {points({{0, 0, 0}, {1, nan, 0}, {0, 1, 0}})}),
                HasSubstr("finite"));
    EXPECT_THAT(errors_of("trianglemesh", {points({{0, 0, 0}, {1e30f, 0, 0}, {0, 1, 0}})},
                          {.world_from_object = Matrix4::scale({1e10, 1, 1})}),
                HasSubstr("the 2nd vertex is not finite in world space"));
}

TEST(PlyMesh, ComesThroughTheReader) {
    auto filename = make_string("filename", "a.ply");
    Making making;
    EXPECT_THAT(errors_of("plymesh", {filename}), HasSubstr("mesh files cannot be read here"));
    making.reader = [](const std::filesystem::path&) -> MeshData {
        throw std::runtime_error("no such file");
    };
    EXPECT_THAT(errors_of("plymesh", {filename}, making), HasSubstr("mesh file \"a.ply\": no such file"));
    MeshData data;
    data.P = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    data.quad_indices = {0, 1, 2, 3};
    making.reader = [&](const std::filesystem::path& path) {
        EXPECT_EQ(path.filename(), "a.ply");
        return data;
    };
    auto mesh = make("plymesh", {filename}, making);
    ASSERT_EQ(mesh->primitive_count(), 1u);
    EXPECT_FLOAT_EQ(mesh->area(0), 1);
    data.P[3].y = nan;
    EXPECT_THAT(errors_of("plymesh", {filename}, making),
                HasSubstr("mesh file \"a.ply\": the 4th value of \"P\" is (1, nan, 0); it must be finite"));
    EXPECT_THAT(errors_of("plymesh", {}), HasSubstr("filename"));
    data = {};
    EXPECT_THAT(errors_of("plymesh", {filename}, making), HasSubstr("there are no vertices"));
}

TEST(PlyMesh, TrianglesAndTwistedQuadrilateralsInOneShape) {
    MeshData data;
    data.P = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1}, {2, 0, 0}, {9, 9, 9}};
    data.quad_indices = {0, 1, 2, 3};
    data.indices = {1, 4, 3};
    data.uv = {{0, 0}, {1, 0}, {0, 1}, {1, 1}, {2, 0}, {9, 9}};
    Making making;
    making.reader = [&](const std::filesystem::path&) { return data; };
    auto mesh = make("plymesh", {make_string("filename", "a.ply"), make_float("alpha", 0.5f)}, making);
    ASSERT_EQ(mesh->primitive_count(), 2u);
    EXPECT_EQ(mesh->triangles(), nullptr);
    EXPECT_EQ(mesh->alpha.constant(), 0.5f);
    // Where the quadrilateral is crossed: z = x y.
    Ray down{{0.5f, 0.25f, 2}, {0, 0, -1}};
    Intersection met;
    EXPECT_FALSE(mesh->intersect(down, 0, met));
    ASSERT_TRUE(mesh->intersect(down, 1, met));
    Hit h = mesh->surface(down, 1, met);
    EXPECT_NEAR(h.p.z, 0.125f, 1e-6f);
    EXPECT_NEAR(h.uv.x, 0.5f, 1e-6f);
    EXPECT_NEAR(h.uv.y, 0.25f, 1e-6f);
    EXPECT_EQ(h.primitive, 1u);
    // The triangle, as its own mesh.
    data.quad_indices = {};
    auto triangle = make("plymesh", {make_string("filename", "a.ply")}, making);
    ASSERT_NE(triangle->triangles(), nullptr);
    EXPECT_EQ(triangle->area(0), mesh->area(0));
}

TEST(PlyMesh, LenientLeavesOddFacesOut) {
    MeshData data;
    data.P = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    data.indices = {0, 1, 2};
    data.odd_faces = 2;
    data.first_odd_face = "line 9: face 1 has 5 vertices; expected 3 or 4";
    Making making;
    making.reader = [&](const std::filesystem::path&) { return data; };
    auto filename = make_string("filename", "a.ply");
    std::string text = "mesh file \"a.ply\": " + data.first_odd_face + " (2 faces like this); ";
    EXPECT_EQ(errors_of("plymesh", {filename}, making),
              "error: " + text + "--lenient would leave such faces out\n");
    Messages messages;
    messages.lenient = true;
    auto mesh = try_make("plymesh", {filename}, messages, making);
    ASSERT_NE(mesh, nullptr);
    EXPECT_EQ(mesh->primitive_count(), 1u);
    EXPECT_EQ(messages.warnings().at(0).text, text + "leaving such faces out");
}

TEST(BilinearMesh, SaysWhatIsWrong) {
    auto square = points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}});
    EXPECT_THAT(errors_of("bilinearmesh", {points({{0, 0, 0}})}), HasSubstr("there are no patches"));
    EXPECT_THAT(errors_of("bilinearmesh", {square, indices({0, 1, 2, 4})}),
                HasSubstr("the 4th value of \"indices\" is 4"));
    EXPECT_THAT(errors_of("bilinearmesh", {square, indices({0, 1, 2})}),
                HasSubstr("it must have 4 for each patch"));
}

TEST(BilinearMesh, HasPbrtsParameters) {
    auto patch = make("bilinearmesh", {points({{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {2, 1, 0}})});
    Hit h = hit(*patch, {{0.5f, 0.75f, 3}, {0, 0, -1}});
    EXPECT_FLOAT_EQ(h.uv.x, 0.25f);
    EXPECT_FLOAT_EQ(h.uv.y, 0.75f);
    EXPECT_EQ(h.ng.z, 1);
    EXPECT_FLOAT_EQ(patch->area(0), 2);
    // Two hits on a saddle: the nearer one, then the other.
    auto saddle = make("bilinearmesh", {points({{0, 0, 0}, {1, 0, 1}, {0, 1, 1}, {1, 1, 0}})});
    Ray ray{{-0.5f, -0.5f, 0.375f}, {1, 1, 0}};
    Hit first = hit(*saddle, ray), second = hit(*saddle, first.spawn(ray.d));
    EXPECT_NEAR(first.p.x, 0.25f, 1e-6);
    EXPECT_NEAR(second.p.x, 0.75f, 1e-6);
}

TEST(BilinearMesh, ATriangleAsAPatchHasNormals) {
    auto patch = make("bilinearmesh", {points({{0, 0, 0}, {0, 0, 0}, {0, 1, 0}, {1, 1, 0}})});
    EXPECT_FLOAT_EQ(patch->area(0), 0.5f);
    EXPECT_NEAR(std::abs(hit(*patch, {{1e-7f, 2e-7f, 1}, {0, 0, -1}}).ng.z), 1, 1e-6);
    EXPECT_NEAR(patch->normals(0).cosine, 1, 1e-5);
}

TEST(SphericalTriangle, AnOctantIsSampledUniformly) {
    // By symmetry the mean direction is 1/2 along each axis.
    SphericalTriangle octant{{2, 0, 0}, {0, 1, 0}, {0, 0, 5}, {0, 0, 0}};
    EXPECT_NEAR(octant.solid_angle(), 3.14159265358979 / 2, 1e-6);
    Vec3d sum;
    constexpr int n = 200;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            Vec2 w = octant.sample({(static_cast<float>(i) + 0.5f) / n, (static_cast<float>(j) + 0.5f) / n});
            ASSERT_GE(std::min({w.x, w.y, 1 - w.x - w.y}), 0);
            sum += normalize(Vec3d(2 * (1 - w.x - w.y), w.x, 5 * w.y));
        }
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(sum[axis] / (n * n), 0.5, 1e-4);
}

// The solid angle of corners a, b, c seen from the origin.
double exact_solid_angle(Vec3d a, Vec3d b, Vec3d c) {
    double x = length(a), y = length(b), z = length(c);
    return std::abs(
        2 * std::atan2(dot(a, cross(b, c)), x * y * z + dot(a, b) * z + dot(a, c) * y + dot(b, c) * x));
}

// Triangles from tiny to wide, seen from straight ahead to nearly edge-on: the part of the triangle whose
// points have smaller numbers u is the part u of the solid angle.
TEST(SphericalTriangle, NumbersCutOffTheirFractionOfTheArea) {
    Rng rng(5);
    auto corner = [&](float size) {
        return Vec3(rng.uniform() - 0.5f, rng.uniform() - 0.5f, rng.uniform() - 0.5f) * size;
    };
    int checked = 0;
    for (int i = 0; i < 4000; ++i) {
        const float size = std::pow(10.0f, 3 * rng.uniform() - 1.5f);
        const Vec3 eye{100, -30, 7}, centre = eye + normalize(corner(1));
        const Vec3 a = centre + corner(size), b = centre + corner(size), c = centre + corner(size);
        SphericalTriangle seen{a, b, c, eye};
        const Vec3d da = Vec3d(a) - Vec3d(eye), db = Vec3d(b) - Vec3d(eye), dc = Vec3d(c) - Vec3d(eye);
        const double whole = exact_solid_angle(da, db, dc);
        if (whole < 3e-4 || whole > 6.22) continue;
        ++checked;
        ASSERT_NEAR(seen.solid_angle(), whole, 1e-5 + 1e-3 * whole);
        for (float part : {0.1f, 0.5f, 0.9f}) {
            Vec2 w = seen.sample({part, 1});
            const Vec3d end = normalize(da * (1.0 - w.x - w.y) + db * double{w.x} + dc * double{w.y});
            ASSERT_NEAR(w.x, 0, 1e-3); // on the side from a to c
            ASSERT_NEAR(exact_solid_angle(da, db, end) / whole, part, 2e-3);
            // The cosine to b falls evenly along the arc.
            Vec2 middle = seen.sample({part, 0.5f});
            const Vec3d m = da * (1.0 - middle.x - middle.y) + db * double{middle.x} + dc * double{middle.y};
            const double full = 1 - dot(normalize(db), end);
            ASSERT_NEAR(1 - dot(normalize(db), normalize(m)), full / 2, 2e-3 * full + 1e-9);
        }
    }
    EXPECT_GT(checked, 1000);
}

// An icosahedron, each triangle cut into four, a few times.
struct Icosphere {
    std::vector<Vec3> P;
    std::vector<int> corners;

    explicit Icosphere(int levels, float radius, Vec3 center) {
        const double g = (1 + std::sqrt(5.0)) / 2;
        for (double a : {-1.0, 1.0})
            for (double b : {-g, g}) {
                add({a, b, 0});
                add({0, a, b});
                add({b, 0, a});
            }
        // Faces: all triples of vertices an edge apart.
        for (int i = 0; i < 12; ++i)
            for (int j = i + 1; j < 12; ++j)
                for (int k = j + 1; k < 12; ++k)
                    if (near(i, j) && near(j, k) && near(k, i)) corners.insert(corners.end(), {i, j, k});
        for (int level = 0; level < levels; ++level) cut();
        for (Vec3& p : P) p = center + p * radius;
    }

    void add(Vec3d p) { P.push_back(Vec3(normalize(p))); }
    const Vec3& at(int i) const { return P[static_cast<std::size_t>(i)]; }
    bool near(int i, int j) const { return length(at(i) - at(j)) < 1.1f; }
    void cut() {
        std::map<std::pair<int, int>, int> middles;
        auto middle = [&](int i, int j) {
            auto [it, is_new] =
                middles.try_emplace({std::min(i, j), std::max(i, j)}, static_cast<int>(P.size()));
            if (is_new) add(Vec3d(at(i)) + Vec3d(at(j)));
            return it->second;
        };
        std::vector<int> finer;
        for (std::size_t f = 0; f < corners.size(); f += 3) {
            int a = corners[f], b = corners[f + 1], c = corners[f + 2];
            int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
        }
        corners = std::move(finer);
    }
};

TEST(TriangleMesh, AnIcosphereIsWatertight) {
    for (float radius : {1e-6f, 1.0f, 1e6f})
        for (Vec3 center : {Vec3{}, Vec3{3, -7, 11} * radius}) {
            Icosphere sphere(3, radius, center);
            auto shape = make("trianglemesh", {points(sphere.P), indices(sphere.corners)});
            const TriangleMesh& mesh = *shape->triangles();
            ASSERT_EQ(mesh.primitive_count(), 1280u);
            auto structure = make_structure(MeshPrimitives(mesh));
            NoTests tests;
            Rng rng(3);
            for (int i = 0; i < 170000; ++i) {
                std::uint32_t k = rng.below(mesh.primitive_count());
                auto corner = mesh.vertices(k);
                Vec3 o =
                    center + Vec3{rng.uniform() - 0.5f, rng.uniform() - 0.5f, rng.uniform() - 0.5f} * radius;
                Vec3 target = i % 4 == 0 ? corner[0] : lerp(rng.uniform(), corner[0], corner[1]);
                Ray ray{o, target - o};
                ASSERT_TRUE(structure->any(ray, tests)) << "radius " << radius << ", ray " << i;
            }
        }
}

} // namespace
} // namespace alhazen
