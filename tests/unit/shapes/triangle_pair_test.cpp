#include "shapes/triangle_pair.h"

#include "shapes/spherical_triangle.h"
#include "tests/unit/shapes/support.h"

namespace alhazen {
namespace {

using namespace shape_test;

std::unique_ptr<Shape> mesh_of(std::vector<Vec3> corners, std::vector<int> indices) {
    return make("trianglemesh", {points(std::move(corners)),
                                 make_array<int>("indices", ValueType::integer, std::move(indices))});
}

// A kite: of its two triangles, one is three times the other.
const std::vector<Vec3> kite{{0, 0, 1}, {2, 0, 1}, {0, 1, 1}, {0, -3, 1}};
const std::vector<int> kite_indices{0, 1, 2, 0, 3, 1};

TEST(TrianglePair, IsMadeOfNeighboursInOnePlaneOnly) {
    auto can_be_made = [](std::vector<Vec3> corners, std::vector<int> indices) {
        const auto mesh = mesh_of(std::move(corners), std::move(indices));
        return TrianglePair::make(*mesh->triangles(), 0) != nullptr;
    };
    EXPECT_TRUE(can_be_made(kite, kite_indices));
    EXPECT_FALSE(can_be_made(kite, {0, 1, 2})) << "there is no second triangle";
    EXPECT_FALSE(can_be_made(kite, {0, 1, 2, 0, 1, 3})) << "they face opposite ways";
    EXPECT_FALSE(can_be_made({{0, 0, 1}, {2, 0, 1}, {0, 1, 1}, {0, -3, 1.1f}}, kite_indices))
        << "they are folded";
    EXPECT_FALSE(
        can_be_made({{0, 0, 1}, {2, 0, 1}, {0, 1, 1}, {5, 0, 1}, {7, 0, 1}, {5, 1, 1}}, {0, 1, 2, 3, 4, 5}))
        << "they are apart";
    EXPECT_FALSE(can_be_made(kite, {0, 1, 1, 0, 3, 1})) << "one has no area";
}

// Points that are uniform over what the eye sees fall on each triangle as often as it is large; by chance
// that fails once in 15,000 runs of another seed (four standard deviations).
void expect_even_choice(const TrianglePair& pair, Vec3 eye, double share_of_first) {
    constexpr int count = 40000;
    Rng rng(3);
    int on_first = 0;
    for (int i = 0; i < count; ++i) {
        const auto s = pair.sample_from(0, eye, {rng.uniform(), rng.uniform()});
        ASSERT_TRUE(s);
        ASSERT_NEAR(s->p.z, 1, 1e-6f);
        if (s->p.y > 0) ++on_first;
        Hit hit;
        hit.p = s->p;
        hit.ng = s->ng;
        ASSERT_NEAR(pair.pdf_from(0, eye, hit, normalize(s->p - eye)), s->pdf, 1e-4f * s->pdf);
    }
    EXPECT_NEAR(on_first, count * share_of_first,
                4 * std::sqrt(count * share_of_first * (1 - share_of_first)));
}

TEST(TrianglePair, ChoosesByWhatTheEyeSees) {
    const auto mesh = mesh_of(kite, kite_indices);
    const auto pair = TrianglePair::make(*mesh->triangles(), 0);
    ASSERT_TRUE(pair);
    const Vec3 eye{0.2f, 0.4f, 0.3f};
    const float first = SphericalTriangle(kite[0], kite[1], kite[2], eye).solid_angle();
    const float second = SphericalTriangle(kite[0], kite[3], kite[1], eye).solid_angle();
    expect_even_choice(*pair, eye, static_cast<double>(first / (first + second)));
    Hit hit;
    EXPECT_FLOAT_EQ(pair->pdf_from(0, eye, hit, {0, 0, 1}), 1 / (first + second));
    // From afar, by area.
    expect_even_choice(*pair, {0, 0, -500}, 0.25);
}

TEST(TrianglePair, PointsOnItAreUniform) {
    const auto mesh = mesh_of(kite, kite_indices);
    const auto pair = TrianglePair::make(*mesh->triangles(), 0);
    EXPECT_FLOAT_EQ(pair->area(0), 4);
    constexpr int side = 200;
    double y = 0;
    for (int i = 0; i < side * side; ++i) {
        const ShapeSample s = pair->sample(0, Vec2((static_cast<float>(i % side) + 0.5f) / side,
                                                   (static_cast<float>(i / side) + 0.5f) / side));
        EXPECT_EQ(s.pdf, 0.25f);
        EXPECT_EQ(s.ng.z, 1);
        y += static_cast<double>(s.p.y) / (side * side);
    }
    // The centroids' heights are 1/3 and -1.
    EXPECT_NEAR(y, 0.25 / 3 - 0.75, 2e-3);
}

TEST(TrianglePair, IsMetWhereItsTrianglesAre) {
    const auto mesh = mesh_of(kite, kite_indices);
    const auto pair = TrianglePair::make(*mesh->triangles(), 0);
    for (float y : {0.2f, -0.8f}) {
        const Ray ray({0.3f, y, 0}, {0, 0, 1});
        Intersection met;
        ASSERT_TRUE(pair->intersect(ray, 0, met));
        const Hit hit = pair->surface(ray, 0, met);
        EXPECT_NEAR(hit.p.y, y, 1e-6f);
        EXPECT_EQ(hit.t, 1);
    }
    Intersection met;
    EXPECT_FALSE(pair->intersect({{-0.1f, 0.2f, 0}, {0, 0, 1}}, 0, met));
    EXPECT_EQ(pair->bounds(0).lo, Vec3(0, -3, 1));
    EXPECT_EQ(pair->bounds(0).hi, Vec3(2, 1, 1));
}

} // namespace
} // namespace alhazen
