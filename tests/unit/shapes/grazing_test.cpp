/// Area sampling of curved surfaces seen edge-on. The density of a sampled point and that of the hit of a ray
/// towards it differ there by factors, since the ray is rounded. That it is the ray alone is shown with
/// closed forms in double precision: each density is right for its own point.
#include "tests/support/area_density.h"
#include "tests/unit/shapes/support.h"

namespace alhazen {
namespace {

using namespace shape_test;
using testing_support::ChosenPoint;
using testing_support::cosine_of;
using testing_support::same_density;

/// A surface as an equation.
struct ExactSurface {
    double curvature;                                    ///< the largest
    std::array<double, 3> (*equation)(Vec3d o, Vec3d d); ///< a, h, c of a t^2 + 2 h t + c = 0 along a ray
    Vec3d (*gradient)(Vec3d p);
};

constexpr double radius = 0.5, twist = 0.25;

const ExactSurface cylinder{1 / radius,
                            [](Vec3d o, Vec3d d) {
                                return std::array{d.x * d.x + d.y * d.y, o.x * d.x + o.y * d.y,
                                                  o.x * o.x + o.y * o.y - radius * radius};
                            },
                            [](Vec3d p) {
                                return Vec3d{p.x, p.y, 0};
                            }};
// z = k x y; nowhere curved more than in the middle.
const ExactSurface saddle{twist,
                          [](Vec3d o, Vec3d d) {
                              return std::array{twist * d.x * d.y,
                                                (twist * (o.x * d.y + o.y * d.x) - d.z) / 2,
                                                twist * o.x * o.y - o.z};
                          },
                          [](Vec3d p) {
                              return Vec3d{-twist * p.y, -twist * p.x, 1};
                          }};

double exact_cosine(const ExactSurface& surface, Vec3d p, Vec3d direction) {
    return std::abs(dot(normalize(surface.gradient(p)), normalize(direction)));
}

// Where the ray, its floats taken as exact, meets the surface: the root nearest to p.
Vec3d exact_hit(const ExactSurface& surface, const Ray& ray, Vec3 p) {
    Vec3d o(ray.o), d(ray.d);
    auto [a, h, c] = surface.equation(o, d);
    double root = std::sqrt(std::max(0.0, h * h - a * c)), q = h > 0 ? -h - root : root - h;
    Vec3d first = o + d * (q / a), second = o + d * (c / q);
    return length(first - Vec3d(p)) < length(second - Vec3d(p)) ? first : second;
}

struct Tally {
    int compared = 0, grazing = 0, far_apart = 0;
};

void compare(const Shape& shape, const ExactSurface& surface, Vec3 from, const ShapeSample& s, Tally& tally) {
    ChosenPoint sampled{s.p, s.p_error, s.pdf};
    // Rounding turns the normal by no more than this: p by half a unit in the last place (2^-25 at 0.5, and
    // the curvature is 2 there), the normal itself, the direction from p's rounding.
    constexpr double turn = 4e-7;
    double cosine = exact_cosine(surface, Vec3d(s.p), Vec3d(s.p) - Vec3d(from));
    ASSERT_NEAR(cosine_of(sampled, from, shape.area(0)), cosine, turn);
    Ray ray{from, normalize(s.p - from)};
    Intersection met;
    for (int n = 0; n < 2 && shape.intersect(ray, 0, met); ++n) {
        Hit hit = shape.surface(ray, 0, met);
        Ray towards{from, ray.d};
        ray = hit.spawn(ray.d);
        met = {};
        if (length(hit.p - s.p) > 5e-3f) continue; // the other side
        ChosenPoint found{hit.p, hit.p_error, shape.pdf_from(0, from, hit, towards.d)};
        // After the first hit the ray starts anew, a rounding off the line.
        if (n == 0) {
            double at_hit = exact_cosine(surface, exact_hit(surface, towards, hit.p), Vec3d(towards.d));
            ASSERT_NEAR(cosine_of(found, from, shape.area(0)), at_hit, turn);
        }
        ASSERT_TRUE(same_density(sampled, found, from, shape.area(0), surface.curvature)) << cosine;
        ++tally.compared;
        tally.grazing += cosine < 2e-3;
        tally.far_apart += std::abs(found.pdf / s.pdf - 1) > 0.02f;
    }
}

Tally compare_many(const Shape& shape, const ExactSurface& surface, float distance) {
    Rng rng(1);
    Tally tally;
    for (int i = 0; i < 40000 && !testing::Test::HasFailure(); ++i) {
        // Low above the plane z = 0, where the saddle is seen flat.
        float phi = 2 * pi * rng.uniform();
        Vec3 from = Vec3(std::cos(phi), std::sin(phi), 0.2f * rng.uniform()) * distance;
        if (auto s = shape.sample_from(0, from, {rng.uniform(), rng.uniform()}))
            compare(shape, surface, from, *s, tally);
    }
    return tally;
}

// The squares of the cosines differ by up to 2 k e (see squared_cosine_slack), so that the densities differ
// by more than 2 % below a cosine of about 7 sqrt(k e): at most 0.5 % of the samples here, and since e grows
// with the distance, some sqrt(20) times as many from 20 times as far.
TEST(Grazing, DensitiesOfACylinderDifferByTheRaysRoundingOnly) {
    auto shape = make("cylinder", {make_float("radius", 0.5f)});
    Tally near = compare_many(*shape, cylinder, 3), far = compare_many(*shape, cylinder, 60);
    EXPECT_GT(near.compared, 30000);
    EXPECT_GT(near.grazing, 20);
    EXPECT_GT(near.far_apart, 0);
    EXPECT_LT(near.far_apart, 0.005 * near.compared);
    EXPECT_GT(far.far_apart, near.far_apart);
    EXPECT_LT(far.far_apart, 5 * near.far_apart);
}

TEST(Grazing, DensitiesOfABilinearPatchDifferByTheRaysRoundingOnly) {
    constexpr auto k = static_cast<float>(twist);
    auto shape = make("bilinearmesh", {points({{-1, -1, k}, {1, -1, -k}, {-1, 1, -k}, {1, 1, k}})});
    Tally near = compare_many(*shape, saddle, 3);
    EXPECT_GT(near.compared, 30000);
    EXPECT_GT(near.grazing, 20);
    EXPECT_LT(near.far_apart, 0.005 * near.compared);
}

} // namespace
} // namespace alhazen
