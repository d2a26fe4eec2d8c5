/// How normals change along surfaces, for bumps: against differences of the normals themselves.
#include "tests/unit/shapes/support.h"

namespace alhazen {

namespace {

using shape_test::make;

std::optional<Hit> hit_of(const Shape& shape, Vec3 o, Vec3 d) {
    const Ray ray{o, d};
    Intersection met;
    for (std::uint32_t i = 0; i < shape.primitive_count(); ++i)
        if (shape.intersect(ray, i, met)) return shape.surface(ray, i, met);
    return std::nullopt;
}

// Over a small step across the surface, the normal changes by its derivatives times the step in uv.
void expect_change(const Shape& shape, Vec3 o, Vec3 d) {
    const auto here = hit_of(shape, o, d);
    ASSERT_TRUE(here);
    const NormalChange change = shape.normal_change(*here);
    for (Vec3 step : {Vec3(0.01f, 0, 0), Vec3(0, 0.01f, 0.004f)}) {
        const auto a = hit_of(shape, o - step, d), b = hit_of(shape, o + step, d);
        ASSERT_TRUE(a && b);
        const Vec3 expected = b->ns - a->ns;
        const Vec2 duv = b->uv - a->uv;
        const Vec3 found = change.dndu * duv.x + change.dndv * duv.y;
        EXPECT_LT(length(found - expected), 0.01f * length(expected) + 2e-5f)
            << found.x << " " << found.y << " " << found.z << ", expected " << expected.x << " " << expected.y
            << " " << expected.z;
    }
}

TEST(NormalChange, OfQuadrics) {
    const Matrix4 turned = Matrix4::rotate(40, {1, 2, 3});
    const Vec3 from{0.3f, 0.2f, -9}, along{0, 0, 1};
    for (bool is_reversed : {false, true})
        for (Vec3d scale : {Vec3d(1, 1, 1), Vec3d(2, 2, 2), Vec3d(1, 2, 0.7)}) {
            const shape_test::Making making{turned * Matrix4::scale(scale), is_reversed};
            expect_change(*make("sphere", {make_float("radius", 1.5f)}, making), from, along);
            expect_change(*make("cylinder",
                                {make_float("radius", 1.5f), make_float("zmin", -4), make_float("zmax", 4)},
                                making),
                          {-9, 0.2f, 0.3f}, {1, 0, 0});
            expect_change(*make("disk", {make_float("radius", 3)}, making), from, along);
        }
}

TEST(NormalChange, OfMeshesWithNormals) {
    const std::vector<Vec3> P{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}},
        N{{-0.5f, -0.3f, -2}, {0.6f, -0.2f, -1}, {0, 0.4f, -1.5f}};
    const std::vector<Vec2> uv{{0.1f, 0.2f}, {0.9f, 0.1f}, {0.4f, 1.7f}};
    for (bool is_reversed : {false, true})
        expect_change(*make("trianglemesh",
                            {make_array("P", ValueType::point3, P), make_array("N", ValueType::normal, N),
                             make_array("uv", ValueType::point2, uv)},
                            {Matrix4::scale({2, 3, 1}), is_reversed}),
                      {0.2f, -0.3f, -5}, {0, 0, 1});
}

} // namespace

} // namespace alhazen
