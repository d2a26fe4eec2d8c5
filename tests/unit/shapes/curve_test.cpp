/// Strands against closed forms and dense sampling.
#include "shapes/bezier.h"
#include "tests/unit/shapes/support.h"

namespace alhazen {
namespace {

using namespace shape_test;
using ::testing::HasSubstr;

Vec3 random_vector(Rng& rng) {
    return {2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 2 * rng.uniform() - 1};
}

struct Met {
    float t, u, v;
    std::uint32_t primitive;
};
std::optional<Met> nearest(const Shape& shape, Ray ray) {
    std::optional<Met> met;
    for (std::uint32_t i = 0; i < shape.primitive_count(); ++i) {
        Intersection hit;
        if (!shape.intersect(ray, i, hit)) continue;
        ray.tmax = hit.t;
        met = Met{hit.t, hit.u, hit.v, i};
    }
    return met;
}

Ray down(float x, float y) {
    return {{x, y, -3}, {0, 0, 2}};
}

TEST(Curve, StraightStrandIsABandThatFacesTheRay) {
    for (const char* type : {"flat", "cylinder"}) {
        auto strand =
            make("curve", {points({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}), make_float("width0", 0.2f),
                           make_float("width1", 0.4f), make_string("type", type)});
        EXPECT_EQ(strand->primitive_count(), 2u); // more would be shorter than three widths
        Rng rng(1);
        for (int i = 0; i < 2000; ++i) {
            const float x = 4 * rng.uniform() - 0.5f, y = 0.6f * rng.uniform() - 0.3f;
            const float u = x / 3, width = 0.2f + 0.2f * u;
            const bool expected = x > 0 && x < 3 && std::abs(y) < width / 2;
            if (std::abs(std::abs(y) - width / 2) < 1e-4f || std::abs(x) < 1e-4f || std::abs(x - 3) < 1e-4f)
                continue;
            auto met = nearest(*strand, down(x, y));
            ASSERT_EQ(met.has_value(), expected) << x << " " << y;
            if (!met) continue;
            EXPECT_NEAR(met->t, 1.5f, 1e-5f);
            EXPECT_NEAR(met->u, u, 1e-4f);
            // The left of the strand's direction, seen along the ray: +z cross +x is +y.
            EXPECT_NEAR(met->v, 0.5f + y / width, 1e-3f);
        }
    }
}

TEST(Curve, NormalsAreThoseOfABandOrATube) {
    auto normal_at = [](const char* type, float y, bool reverse) {
        auto strand =
            make("curve", {points({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}), make_string("type", type)},
                 {{}, reverse});
        const Ray ray = down(1.5f, y);
        auto met = nearest(*strand, ray);
        EXPECT_TRUE(met);
        Intersection hit{met->t, met->u, met->v, 0, 0};
        Hit h = strand->surface(ray, met->primitive, hit);
        EXPECT_NEAR(dot(h.ng, h.dpdu), 0, 1e-5f);
        EXPECT_NEAR(dot(h.ng, h.dpdv), 0, 1e-5f);
        EXPECT_NEAR(length(h.dpdu), 3, 1e-4f);
        EXPECT_NEAR(length(h.dpdv), 1, 1e-4f);
        return h.ng;
    };
    // dpdu x dpdv, which points along the ray as in pbrt-v4.
    EXPECT_LT(length(normal_at("flat", 0.4f, false) - Vec3(0, 0, 1)), 1e-5f);
    EXPECT_LT(length(normal_at("flat", 0.4f, true) - Vec3(0, 0, -1)), 1e-5f);
    EXPECT_LT(length(normal_at("cylinder", 0, false) - Vec3(0, 0, 1)), 1e-5f);
    // Half way to the rim: 45 degrees.
    const float s = std::sqrt(0.5f);
    EXPECT_LT(length(normal_at("cylinder", 0.25f, false) - Vec3(0, s, s)), 1e-4f);
    EXPECT_LT(length(normal_at("cylinder", -0.25f, false) - Vec3(0, -s, s)), 1e-4f);
}

TEST(Curve, RibbonIsAsWideAsItIsSeen) {
    auto ribbon = [](Vec3 n) {
        return make("curve",
                    {points({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}), make_string("type", "ribbon"),
                     make_array<Vec3>("N", ValueType::normal, {n, n})});
    };
    for (float degrees : {0.0f, 30.0f, 60.0f, 85.0f}) {
        const float c = std::cos(radians(degrees)), s = std::sin(radians(degrees));
        auto shape = ribbon({0, 2 * s, 2 * c});
        EXPECT_TRUE(nearest(*shape, down(1.5f, 0.49f * c)));
        EXPECT_FALSE(nearest(*shape, down(1.5f, 0.51f * c)));
        auto met = nearest(*shape, down(1.5f, 0.1f * c));
        ASSERT_TRUE(met);
        EXPECT_NEAR(met->v, 0.6f, 1e-4f);
        Hit h = shape->surface(down(1.5f, 0.1f * c), met->primitive, {met->t, met->u, met->v, 0, 0});
        EXPECT_LT(length(h.ng - Vec3(0, s, c)), 1e-4f);
    }
    EXPECT_FALSE(nearest(*ribbon({0, 1, 0}), down(1.5f, 0)));
    // Half way between two normals.
    auto twisted =
        make("curve", {points({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}), make_string("type", "ribbon"),
                       make_array<Vec3>("N", ValueType::normal, {{0, 0, 1}, {0, 1, 0}})});
    EXPECT_TRUE(nearest(*twisted, down(1.5f, 0.49f * std::sqrt(0.5f))));
    EXPECT_FALSE(nearest(*twisted, down(1.5f, 0.51f * std::sqrt(0.5f))));
}

const CubicBezier loop{Vec3{-1, 0, 0}, {2, 1.5f, 0.5f}, {-2, 1.2f, -0.5f}, {1, -0.3f, 0.4f}};

// The first place along the ray where a dense sampling of the curve says that it is met.
struct Expected {
    bool is_hit = false, is_doubtful = false;
    float t = infinity, u = 0;
};
Expected by_sampling(const CubicBezier& c, float width0, float width1, const Ray& ray) {
    constexpr int n = 20000;
    Expected e;
    auto distance = [&](int i) {
        Vec3d p = Vec3d(bezier_point(c, static_cast<float>(i) / n)) - Vec3d(ray.o), d(ray.d);
        return length(cross(p, d));
    };
    double before = distance(0), here = distance(1);
    for (int i = 1; i < n; ++i, before = here, here = distance(i)) {
        if (!(here <= before && here < distance(i + 1))) continue;
        const float u = static_cast<float>(i) / n, half = 0.5f * lerp(u, width0, width1);
        const float t = dot(bezier_point(c, u) - ray.o, ray.d);
        e.is_doubtful |= std::abs(here - static_cast<double>(half)) < 0.01 * static_cast<double>(half);
        if (!(here < static_cast<double>(half) && t > 0)) continue;
        // Two minima side by side: a bend around the ray, narrower than the strand is wide.
        e.is_doubtful |= e.is_hit && std::abs(u - e.u) < 0.2f;
        if (t < e.t) e = {true, e.is_doubtful, t, u};
    }
    return e;
}

TEST(Curve, IsMetWhereDenseSamplingSaysSo) {
    constexpr float width0 = 0.15f, width1 = 0.05f;
    int hits = 0, doubtful = 0;
    for (int splitdepth : {0, 3}) {
        auto strand = make("curve", {points({loop.begin(), loop.end()}), make_float("width0", width0),
                                     make_float("width1", width1), make_integer("splitdepth", splitdepth)});
        Rng rng(2);
        for (int i = 0; i < 400; ++i) {
            // Aimed near the curve.
            Ray ray{random_vector(rng) * 5.0f, {}};
            ray.d = normalize(bezier_point(loop, rng.uniform()) + random_vector(rng) * 0.1f - ray.o);
            Expected e = by_sampling(loop, width0, width1, ray);
            doubtful += e.is_doubtful;
            if (e.is_doubtful) continue;
            auto met = nearest(*strand, ray);
            ASSERT_EQ(met.has_value(), e.is_hit) << i;
            if (!met) continue;
            ++hits;
            // Near a centre of curvature the nearest point is hard to tell, but not how near it is.
            auto distance = [&](float u) { return length(cross(bezier_point(loop, u) - ray.o, ray.d)); };
            ASSERT_NEAR(met->u, e.u, 0.03f);
            ASSERT_NEAR(distance(met->u), distance(e.u), 0.02f * width0);
            ASSERT_NEAR(met->t, dot(bezier_point(loop, met->u) - ray.o, ray.d), 1e-5f);
        }
    }
    EXPECT_GT(hits, 300);
    EXPECT_LT(doubtful, 100);
}

TEST(Curve, PartsMeetWithoutGapOrOverlap) {
    // Along the middle line, every ray meets exactly one part or, between two, one or both.
    auto strand = make("curve", {points({loop.begin(), loop.end()}), make_float("width", 0.05f),
                                 make_integer("splitdepth", 6)});
    for (int i = 1; i < 5000; ++i) {
        const float u = static_cast<float>(i) / 5000;
        const Vec3 p = bezier_point(loop, u), d = normalize(Vec3(0.3f, 0.2f, 1));
        auto met = nearest(*strand, {p - d * 0.04f, d, 0.08f});
        ASSERT_TRUE(met) << u;
        EXPECT_NEAR(met->u, u, 0.02f);
    }
}

TEST(Curve, BoxesAreTight) {
    auto strand = make("curve", {points({loop.begin(), loop.end()}), make_float("width", 0.02f)});
    for (std::uint32_t i = 0; i < 8; ++i) {
        Bounds3 box = strand->bounds(i), sampled;
        for (int k = 0; k <= 1000; ++k) {
            const float u = (static_cast<float>(i) + static_cast<float>(k) / 1000) / 8;
            sampled.extend(bezier_point(loop, u) - Vec3(0.01f));
            sampled.extend(bezier_point(loop, u) + Vec3(0.01f));
        }
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(box.lo[axis], sampled.lo[axis], 1e-5f);
            EXPECT_NEAR(box.hi[axis], sampled.hi[axis], 1e-5f);
        }
    }
}

TEST(Curve, RaysThatLeaveAStraightStrandDoNotMeetItAgain) {
    for (const char* type : {"flat", "cylinder"}) {
        auto strand = make("curve", {points({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}),
                                     make_float("width", 0.1f), make_string("type", type)});
        Rng rng(3);
        for (int i = 0; i < 5000; ++i) {
            const Vec3 from = random_vector(rng) * 4.0f;
            const Vec3 to{3 * rng.uniform(), 0.04f * rng.uniform(), 0.04f * rng.uniform()};
            const Ray ray{from, normalize(to - from)};
            auto met = nearest(*strand, ray);
            if (!met) continue;
            Hit h = strand->surface(ray, met->primitive, {met->t, met->u, met->v, 0, 0});
            ASSERT_FALSE(nearest(*strand, h.spawn(normalize(random_vector(rng)))));
        }
    }
}

TEST(Curve, StretchedIsCutInObjectSpace) {
    // Twice as wide along y, as pbrt-v4 has it.
    auto strand =
        make("curve", {points({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}), make_float("width", 0.2f)},
             {Matrix4::scale({1, 2, 1})});
    EXPECT_TRUE(nearest(*strand, down(1, 0.19f)));
    EXPECT_FALSE(nearest(*strand, down(1, 0.21f)));
    const Ray across{{1, -3, 0.09f}, {0, 1, 0}}, beside{{1, -3, 0.11f}, {0, 1, 0}};
    EXPECT_TRUE(nearest(*strand, across));
    EXPECT_FALSE(nearest(*strand, beside));
    // Mirroring turns normals over and swaps left and right.
    auto mirrored =
        make("curve", {points({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}), make_float("width", 0.2f)},
             {Matrix4::scale({1, -1, 1})});
    auto met = nearest(*mirrored, down(1, 0.05f));
    ASSERT_TRUE(met);
    EXPECT_NEAR(met->v, 0.25f, 1e-4f);
}

TEST(Curve, AreaIsLengthTimesWidth) {
    auto strand = make("curve", {points({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}),
                                 make_float("width0", 0.1f), make_float("width1", 0.3f)});
    float area = 0;
    for (std::uint32_t i = 0; i < strand->primitive_count(); ++i) area += strand->area(i);
    EXPECT_NEAR(area, 0.6f, 1e-5f);
    EXPECT_FALSE(strand->can_be_light());
}

TEST(Curve, DegenerateStrandsAreHarmless) {
    for (auto p : {std::vector<Vec3>(4, {0, 0, 0}), {{0, 0, -1}, {0, 0, 0}, {0, 0, 1}, {0, 0, 2}}}) {
        auto strand = make("curve", {points(p)});
        auto met = nearest(*strand, down(0.1f, 0.2f));
        if (met) {
            Hit h = strand->surface(down(0.1f, 0.2f), met->primitive, {met->t, met->u, met->v, 0, 0});
            EXPECT_TRUE(is_finite(h.ng) && is_finite(h.p));
        }
    }
    // The ends coincide with their neighbours.
    auto pinched = make("curve", {points({{0, 0, 0}, {0, 0, 0}, {3, 0, 0}, {3, 0, 0}})});
    EXPECT_TRUE(nearest(*pinched, down(1.5f, 0.4f)));
    auto none = make("curve", {points({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}), make_float("width", 0)});
    EXPECT_FALSE(nearest(*none, down(1.5f, 0)));
}

TEST(Curve, SaysWhatIsWrong) {
    const std::vector<Vec3> five(5, {0, 0, 0});
    EXPECT_THAT(
        errors_of("curve", {points(five)}),
        HasSubstr(
            "parameter \"P\" has 5 points; a curve of Bezier basis and degree 3 must have 4, 7, 10 ..."));
    EXPECT_THAT(errors_of("curve", {points({{0, 0, 0}, {1, 0, 0}}), make_integer("degree", 2),
                                    make_string("basis", "bspline")}),
                HasSubstr("has 2 points; a B-spline of degree 2 must have at least 3"));
    EXPECT_THAT(
        errors_of("curve", {points({five.begin(), five.begin() + 4}), make_string("type", "ribbon")}),
        HasSubstr("this ribbon of 1 segments must have 2 normals \"N\", one at each end of each; it has 0"));
    EXPECT_THAT(errors_of("curve", {points({five.begin(), five.begin() + 4}), make_string("type", "ribbon"),
                                    make_array<Vec3>("N", ValueType::normal, {{0, 0, 1}, {0, 0, 0}})}),
                HasSubstr("normal that is zero"));
    EXPECT_THAT(errors_of("curve", {points({{0, 0, 0}, {infinity, 0, 0}, {0, 0, 0}, {0, 0, 0}})}),
                HasSubstr("\"P\""));
    EXPECT_THAT(errors_of("curve", {}), HasSubstr("needs the parameter"));
    EXPECT_THAT(errors_of("curve", {points(five), make_integer("degree", 4)}), HasSubstr("degree"));
    Messages messages;
    EXPECT_TRUE(try_make(
        "curve",
        {points({five.begin(), five.begin() + 4}), make_array<Vec3>("N", ValueType::normal, {{0, 0, 1}})},
        messages));
    EXPECT_THAT(messages.list()[0].text, HasSubstr("only ribbons have normals"));
}

} // namespace
} // namespace alhazen
