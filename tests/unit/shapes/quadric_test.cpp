#include "tests/unit/shapes/support.h"

namespace alhazen {
namespace {

using namespace shape_test;
using testing::HasSubstr;

void expect_near(Vec3 a, Vec3 b, float tolerance) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "axis " << i;
}

TEST(Sphere, HasPbrtsParameters) {
    auto sphere = make("sphere", {make_float("radius", 2)});
    // u: angle around z over phimax; v: angle from the axis, 0 at zmin.
    Hit h = hit(*sphere, {{0, 5, 0}, {0, -1, 0}});
    EXPECT_NEAR(h.uv.x, 0.25f, 1e-6);
    EXPECT_NEAR(h.uv.y, 0.5f, 1e-6);
    expect_near(h.p, {0, 2, 0}, 1e-6f);
    expect_near(h.dpdu, {-4 * pi, 0, 0}, 1e-5f);
    expect_near(h.dpdv, {0, 0, 2 * pi}, 1e-5f);
    EXPECT_EQ(h.t, 3);
    EXPECT_NEAR(hit(*sphere, {{0, 0.001f, -5}, {0, 0, 1}}).uv.y, 0, 1e-3);
}

TEST(Sphere, NormalsPointOutUnlessTurned) {
    std::vector<Parameter> radius{make_float("radius", 1)};
    Ray ray{{-5, 0, 0}, {1, 0, 0}};
    Matrix4 mirror = Matrix4::scale({-1, 1, 1});
    EXPECT_EQ(hit(*make("sphere", radius), ray).ng.x, -1);
    EXPECT_EQ(hit(*make("sphere", radius, {.reverse = true}), ray).ng.x, 1);
    EXPECT_EQ(hit(*make("sphere", radius, {.world_from_object = mirror}), ray).ng.x, 1);
    EXPECT_EQ(hit(*make("sphere", radius, {.world_from_object = mirror, .reverse = true}), ray).ng.x, -1);
}

TEST(Sphere, CutsShowTheInside) {
    auto dome = make("sphere", {make_float("radius", 1), make_float("zmin", 0)});
    // From below, through where the lower half would be.
    Hit h = hit(*dome, {{0, 0, -5}, {0, 0, 1}});
    EXPECT_EQ(h.t, 6);
    EXPECT_EQ(h.ng.z, 1);
    auto wedge = make("sphere", {make_float("phimax", 90)});
    Intersection met;
    EXPECT_FALSE(wedge->intersect({{-0.1f, -0.1f, 5}, {0, 0, -1}}, 0, met));
    EXPECT_TRUE(wedge->intersect({{0.1f, 0.1f, 5}, {0, 0, -1}}, 0, met));
    EXPECT_NEAR(wedge->area(0), pi, 1e-5);
    EXPECT_NEAR(wedge->bounds(0).lo.x, 0, 1e-6);
}

TEST(Sphere, HitsAreRoundedDoubles) {
    // A floor of radius 10000 and rays that leave it upwards: none comes back, none is lost.
    auto floor = make("sphere", {make_float("radius", 10000)},
                      {.world_from_object = Matrix4::translate({0, -10001, 0})});
    Rng rng(1);
    for (int i = 0; i < 100000; ++i) {
        Vec3 o{10 * rng.uniform() - 5, 3 * rng.uniform(), 10 * rng.uniform() - 5};
        Vec3 target{100 * rng.uniform() - 50, -1.0f, 100 * rng.uniform() - 50};
        Ray ray{o, normalize(target - o)};
        Intersection met;
        if (!floor->intersect(ray, 0, met)) continue;
        Hit h = floor->surface(ray, 0, met);
        Vec3d from_centre = Vec3d(h.p) - Vec3d{0, -10001, 0};
        ASSERT_LT(std::abs(length(from_centre) - 10000), 1e-6);
        Vec3 up{rng.uniform() - 0.5f, 1e-3f * rng.uniform(), rng.uniform() - 0.5f};
        up += h.ng * (1e-6f + std::max(0.0f, -dot(up, h.ng)));
        ASSERT_FALSE(floor->intersect(h.spawn(up), 0, met));
        ASSERT_TRUE(floor->intersect(h.spawn(-h.ng), 0, met));
        ASSERT_NEAR(met.t, 20000, 0.1);
    }
}

TEST(Sphere, FarAwayRaysKeepTheirPrecision) {
    auto sphere = make("sphere", {make_float("radius", 1)});
    // A grazing ray from 10^6 away: the discriminant has to survive 10^12 - 10^12.
    for (float y : {0.999f, 0.9999f, 0.99999f}) {
        Hit h = hit(*sphere, {{-1e6f, y, 0}, {1, 0, 0}});
        EXPECT_NEAR(h.p.x, -std::sqrt((1.0 - static_cast<double>(y)) * (1.0 + static_cast<double>(y))), 1e-7);
    }
    Intersection met;
    EXPECT_FALSE(sphere->intersect({{-1e6f, 1.000001f, 0}, {1, 0, 0}}, 0, met));
}

TEST(Sphere, IsSampledInItsConeFromOutside) {
    auto sphere =
        make("sphere", {make_float("radius", 1)}, {.world_from_object = Matrix4::translate({0, 0, 10})});
    // Solid angle 2 pi (1 - cos) with sin = 1 / 10.
    float expected = 1 / (2 * pi * (1 - std::sqrt(0.99f)));
    auto s = sphere->sample_from(0, {0, 0, 0}, {0.3f, 0.6f});
    ASSERT_TRUE(s);
    EXPECT_NEAR(s->pdf / expected, 1, 1e-4);
    EXPECT_LT(s->p.z, 10);
    // From so far away that the cone's cosine is one in floats.
    auto far = sphere->sample_from(0, {0, 0, -1e6f}, {0.3f, 0.6f});
    ASSERT_TRUE(far);
    EXPECT_NEAR(far->pdf * pi / 1e12f, 1, 1e-3);
}

TEST(Disk, FacesUp) {
    auto disk = make("disk", {make_float("height", 2), make_float("innerradius", 0.5f)});
    Hit h = hit(*disk, {{0.75f, 0, 5}, {0, 0, -1}});
    EXPECT_EQ(h.ng.z, 1);
    EXPECT_EQ(h.p.z, 2);
    EXPECT_NEAR(h.uv.y, 0.5f, 1e-6);
    EXPECT_NEAR(disk->area(0), pi * 0.75f, 1e-5);
    Intersection met;
    EXPECT_FALSE(disk->intersect({{0.25f, 0, 5}, {0, 0, -1}}, 0, met));
    EXPECT_FALSE(disk->intersect({{1.25f, 0, 5}, {0, 0, -1}}, 0, met));
    EXPECT_FALSE(disk->intersect({{-3, 0, 2}, {1, 0, 0}}, 0, met));
    EXPECT_EQ(disk->normals(0).cosine, 1);
}

TEST(Cylinder, IsOpenAtItsEnds) {
    auto tube = make("cylinder", {make_float("radius", 1)});
    Intersection met;
    EXPECT_FALSE(tube->intersect({{0.5f, 0, 5}, {0, 0, -1}}, 0, met));
    Hit h = hit(*tube, {{5, 0, 0.5f}, {-1, 0, 0}});
    EXPECT_EQ(h.ng.x, 1);
    EXPECT_NEAR(h.uv.y, 0.75f, 1e-6);
    EXPECT_NEAR(tube->area(0), 4 * pi, 1e-5);
}

TEST(Quadrics, EllipsoidsHaveTheirTrueArea) {
    // Prolate spheroid, half axes 1, 1, 2: 2 pi a^2 (1 + c / (a e) asin e) with e^2 = 1 - a^2 / c^2.
    double e = std::sqrt(0.75), expected = 2 * 3.14159265358979 * (1 + 2 / e * std::asin(e));
    auto shape = make("sphere", {}, {.world_from_object = Matrix4::scale({1, 1, 2})});
    EXPECT_NEAR(shape->area(0), expected, 1e-4 * expected);
    // Stretched across the axis of the grid as well.
    shape = make("sphere", {}, {.world_from_object = Matrix4::scale({2, 1, 1})});
    EXPECT_NEAR(shape->area(0), expected, 1e-4 * expected);
}

TEST(Quadrics, TakeTheirEndsInAnyOrder) {
    for (const char* type : {"sphere", "cylinder"}) {
        auto ordered = make(type, {make_float("zmin", -0.5f), make_float("zmax", 0.25f)});
        auto exchanged = make(type, {make_float("zmin", 0.25f), make_float("zmax", -0.5f)});
        EXPECT_EQ(exchanged->area(0), ordered->area(0));
        EXPECT_EQ(exchanged->bounds(0).lo, ordered->bounds(0).lo);
    }
}

TEST(Quadrics, SayWhatIsWrong) {
    EXPECT_THAT(errors_of("sphere", {make_float("radius", 0)}), HasSubstr("\"radius\" is 0; it must be"));
    EXPECT_THAT(errors_of("sphere", {make_float("radius", -1)}), HasSubstr("\"radius\" is -1"));
    EXPECT_THAT(errors_of("sphere", {make_float("zmin", 0.5f), make_float("zmax", 0.5f)}),
                HasSubstr("they must be two heights"));
    EXPECT_THAT(errors_of("sphere", {make_float("zmin", 2)}),
                HasSubstr("leaves nothing of a sphere of radius 1"));
    EXPECT_THAT(errors_of("sphere", {make_float("phimax", 0)}), HasSubstr("phimax"));
    EXPECT_THAT(errors_of("sphere", {make_float("phimax", 361)}), HasSubstr("phimax"));
    EXPECT_THAT(errors_of("sphere", {make_float("raduis", 1)}), HasSubstr("did you mean \"radius\""));
    EXPECT_THAT(errors_of("disk", {make_float("innerradius", 1)}),
                HasSubstr("innerradius is 1; it must be less than radius, 1"));
    EXPECT_THAT(errors_of("disk", {make_float("innerradius", -1)}), HasSubstr("innerradius"));
    EXPECT_THAT(errors_of("cylinder", {make_float("zmin", 1)}),
                HasSubstr("zmin and zmax are both 1; they must be two heights"));
    EXPECT_THAT(errors_of("shpere", {}), HasSubstr("did you mean \"sphere\""));
}

} // namespace
} // namespace alhazen
