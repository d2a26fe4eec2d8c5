// Meshes cut finely and moved along their normals.
#include <map>

#include "shapes/mesh_displacement.h"
#include "shapes/triangle_mesh.h"
#include "tests/unit/shapes/support.h"

namespace alhazen {
namespace {

using namespace shape_test;
using testing::HasSubstr;

template <class F>
struct Formula final : FloatNode {
    F f;
    explicit Formula(F f_) : f(f_) {}
    float eval(const TexturePoint& at) const override { return f(at); }
};
template <class F>
FloatTexture formula(F f) {
    return FloatTexture(std::make_shared<Formula<F>>(f));
}

// A square from 0 to 1 in x and y, as one quadrilateral, with uv that differ from the place.
MeshData square() {
    MeshData mesh;
    mesh.P = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    mesh.uv = {{2, 1}, {4, 1}, {2, 4}, {4, 4}};
    mesh.quad_indices = {0, 1, 2, 3};
    return mesh;
}

MeshData octahedron_mesh() {
    MeshData mesh;
    mesh.P = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    mesh.uv.resize(6);
    mesh.indices = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    return mesh;
}

const Vec3& corner(const MeshData& mesh, std::size_t i) {
    return mesh.P[static_cast<std::size_t>(mesh.indices[i])];
}

// Each edge is there once in either direction: the surface is closed, and nothing lies on an edge.
void expect_closed(const MeshData& mesh) {
    std::map<std::pair<int, int>, int> edges;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k) ++edges[{mesh.indices[i + k], mesh.indices[i + (k + 1) % 3]}];
    for (const auto& [edge, count] : edges) {
        ASSERT_EQ(count, 1);
        ASSERT_EQ(edges.count({edge.second, edge.first}), 1u);
    }
}

TEST(MeshDisplacement, CutsUntilEdgesAreShortInTheWorld) {
    const Transform stretched(Matrix4::rotate(30, {1, 2, 3}) * Matrix4::scale({4, 1, 0.5}));
    for (float longest : {10.0f, 2.0f, 0.3f, 0.05f}) {
        MeshData mesh = octahedron_mesh();
        ASSERT_EQ((Displacement{0.0f, longest, stretched}.apply(mesh)), "");
        double most = 0;
        for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
            const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
            most =
                std::max(most, length(stretched.vector(Vec3d(corner(mesh, next)) - Vec3d(corner(mesh, i)))));
        }
        EXPECT_LT(most, longest);
        // What is short enough stays whole.
        EXPECT_EQ(mesh.indices.size() == 24, longest == 10.0f);
        expect_closed(mesh);
        EXPECT_EQ(mesh.N.size(), mesh.P.size());
        EXPECT_EQ(mesh.uv.size(), mesh.P.size());
    }
}

TEST(MeshDisplacement, HasNoCracksWhereTheTextureIsRough) {
    MeshData mesh = octahedron_mesh();
    auto rough =
        formula([](const TexturePoint& at) { return 0.2f * std::sin(40 * at.p.x + 31 * at.p.y * at.p.z); });
    ASSERT_EQ((Displacement{rough, 0.1f, Transform()}.apply(mesh)), "");
    EXPECT_GT(mesh.indices.size() / 3, 1000u);
    expect_closed(mesh);
    // Outward still.
    for (std::size_t i = 0; i < 6; ++i) EXPECT_GT(dot(mesh.N[i], mesh.P[i]), 0);
}

TEST(MeshDisplacement, ASphereGrows) {
    MeshData mesh = octahedron_mesh();
    // Three times: cut, and laid onto the sphere, whose normals are then known.
    for (int level = 0; level < 3; ++level) {
        mesh.N = mesh.P;
        ASSERT_EQ((Displacement{0.0f, 0.8f / static_cast<float>(1 << level), Transform()}.apply(mesh)), "");
        for (Vec3& p : mesh.P) p = normalize(p);
    }
    mesh.N = mesh.P;
    for (Vec3& n : mesh.N) n = n * 7; // the length of a normal does not matter
    const std::size_t triangles = mesh.indices.size();
    ASSERT_EQ((Displacement{0.25f, 10, Transform()}.apply(mesh)), "");
    EXPECT_EQ(mesh.indices.size(), triangles);
    for (std::size_t i = 0; i < mesh.P.size(); ++i) {
        EXPECT_NEAR(length(mesh.P[i]), 1.25f, 1e-6f);
        EXPECT_NEAR(length(mesh.N[i]), 1, 1e-6f);
        EXPECT_GT(dot(mesh.N[i], normalize(mesh.P[i])), 0.99f);
    }
}

TEST(MeshDisplacement, TexturesAreLookedUpAtTheVertex) {
    MeshData mesh = square();
    auto by_uv = formula([](const TexturePoint& at) { return at.uv.x * at.uv.x + 0.5f * at.uv.y; });
    ASSERT_EQ((Displacement{by_uv, 0.2f, Transform()}.apply(mesh)), "");
    EXPECT_GT(mesh.P.size(), 40u);
    for (std::size_t i = 0; i < mesh.P.size(); ++i) {
        const Vec3 p = mesh.P[i];
        const Vec2 uv{2 + 2 * p.x, 1 + 3 * p.y};
        EXPECT_NEAR(mesh.uv[i].x, uv.x, 1e-5f);
        EXPECT_NEAR(mesh.uv[i].y, uv.y, 1e-5f);
        EXPECT_NEAR(p.z, uv.x * uv.x + 0.5f * uv.y, 1e-4f);
    }
    // p and the normal in the world; the height in object space.
    mesh = square();
    const Matrix4 moved =
        Matrix4::translate({10, 20, 30}) * Matrix4::rotate(90, {1, 0, 0}) * Matrix4::scale({2, 2, 2});
    auto by_place = formula([](const TexturePoint& at) {
        EXPECT_NEAR(at.ng.y, -1, 1e-6f);
        return at.p.x + at.p.y + 2 * at.p.z;
    });
    ASSERT_EQ((Displacement{by_place, 0.5f, Transform(moved)}.apply(mesh)), "");
    for (const Vec3& p : mesh.P) EXPECT_NEAR(p.z, (10 + 2 * p.x) + 20 + 2 * (30 + 2 * p.y), 1e-4f);
}

TEST(MeshDisplacement, NormalsAreThoseOfTheDisplacedSurface) {
    MeshData mesh = square();
    auto slope = formula([](const TexturePoint& at) { return 0.75f * at.p.x; });
    ASSERT_EQ((Displacement{slope, 0.1f, Transform()}.apply(mesh)), "");
    for (const Vec3& n : mesh.N) EXPECT_LT(length(n - Vec3(-0.6f, 0, 0.8f)), 1e-5f);
}

TEST(MeshDisplacement, RefusesWhatWouldNeverEnd) {
    const std::string text = "edges shorter than 0.001 would take more than 10000 triangles; take a longer";
    MeshData mesh = square();
    EXPECT_THAT((Displacement{0.0f, 0.001f, Transform(), 10000}.apply(mesh)), HasSubstr(text));
    // Long and thin: hardly any area, and many edges.
    mesh = square();
    const Transform thin(Matrix4::scale({100, 1e-6, 1}));
    EXPECT_THAT((Displacement{0.0f, 0.001f, thin, 10000}.apply(mesh)), HasSubstr(text));
    // Far from the origin single precision has no point between two.
    mesh = square();
    for (Vec3& p : mesh.P) p += Vec3(4194304.0f, 0, 0);
    EXPECT_THAT((Displacement{0.0f, 0.001f, Transform()}.apply(mesh)),
                HasSubstr("single precision has no numbers between"));
}

TEST(MeshDisplacement, SaysWhatIsWrong) {
    MeshData mesh = square();
    mesh.uv.clear();
    EXPECT_THAT((Displacement{0.0f, 1, Transform()}.apply(mesh)), HasSubstr("no texture coordinates"));
    mesh = square();
    auto pole = formula([](const TexturePoint& at) { return 1 / (at.uv.x - 4); });
    EXPECT_THAT((Displacement{pole, 4, Transform()}.apply(mesh)),
                HasSubstr("\"displacement\" is inf at the texture coordinates (4, 1); it must be finite"));
}

TEST(PlyMesh, Displaces) {
    Making making;
    making.reader = [](const std::filesystem::path&) { return square(); };
    making.world_from_object = Matrix4::scale({1, 1, 3});
    auto filename = make_string("filename", "a.ply");
    auto height = make_float("displacement", 0.5f);
    for (const char* name : {"edgelength", "displacement.edgelength"}) {
        auto shape = make("plymesh", {filename, height, make_float(name, 0.25f)}, making);
        ASSERT_NE(shape->triangles(), nullptr);
        EXPECT_GE(shape->primitive_count(), 32u);
        for (const Vec3& p : shape->triangles()->P) EXPECT_EQ(p.z, 1.5f);
    }
    EXPECT_EQ(make("plymesh", {filename, height, make_float("edgelength", 2)}, making)->primitive_count(),
              2u);
    making.edge_scale = 0.125f;
    EXPECT_GE(make("plymesh", {filename, height, make_float("edgelength", 2)}, making)->primitive_count(),
              32u);
    EXPECT_THAT(errors_of("plymesh",
                          {filename, make_float("edgelength", 1), make_float("displacement.edgelength", 1)},
                          making),
                HasSubstr("are one parameter; give one of them"));
    EXPECT_THAT(errors_of("plymesh", {filename, make_float("edgelength", 0)}, making),
                HasSubstr("edgelength"));
    making.reader = [](const std::filesystem::path&) {
        MeshData mesh = square();
        mesh.uv.clear();
        return mesh;
    };
    EXPECT_THAT(errors_of("plymesh", {filename, height}, making),
                HasSubstr("mesh file \"a.ply\": the mesh has no texture coordinates"));
}

} // namespace
} // namespace alhazen
