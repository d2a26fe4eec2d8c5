// What every reconstruction filter promises, checked for each kind and each documented example.
#include <gtest/gtest.h>

#include "film/filter.h"
#include "tests/support/density_test.h"
#include "tests/support/family.h"

namespace alhazen {
namespace {

using testing_support::chi_square_2d;
using testing_support::p_threshold;

template <class Visit>
void for_each_filter(Visit visit) {
    testing_support::for_each_example(
        filter_kinds(), [&](const std::string& kind, const std::string&, Filter& f) { visit(kind, f); });
}

// Midpoint rule over the filter's rectangle.
template <class F>
double integrate(const Filter& f, F function) {
    constexpr int n = 400;
    Vec2 r = f.radius();
    double sum = 0;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
            sum += function(Vec2(r.x * (2 * (static_cast<float>(x) + .5f) / n - 1),
                                 r.y * (2 * (static_cast<float>(y) + .5f) / n - 1)));
    return sum * 4 * static_cast<double>(r.x * r.y) / (n * n);
}

TEST(FilterConformance, IntegralIsTheIntegral) {
    for_each_filter([](const std::string&, const Filter& f) {
        double expected = integrate(f, [&](Vec2 p) { return f.eval(p); });
        EXPECT_NEAR(f.integral(), expected, 1e-3 * std::abs(expected));
    });
}

TEST(FilterConformance, IsEvenAndZeroOutside) {
    for_each_filter([](const std::string&, const Filter& f) {
        Vec2 r = f.radius();
        for (Vec2 p : {Vec2(.1f, .2f), Vec2(.9f, .3f), Vec2(.5f, .99f)}) {
            Vec2 q = p * r;
            for (Vec2 mirrored : {Vec2(-q.x, q.y), Vec2(q.x, -q.y), -q})
                EXPECT_NEAR(f.eval(mirrored), f.eval(q), 1e-6f);
        }
        EXPECT_EQ(f.eval({r.x * 1.01f, 0}), 0);
        EXPECT_EQ(f.eval({0, -r.y * 1.01f}), 0);
        EXPECT_GT(f.eval({0, 0}), 0);
    });
}

// The steps of a table are no more than a 128th of the radius wide; a cell of this test holds 8 of them.
TEST(FilterConformance, SamplesFollowTheFiltersSize) {
    for_each_filter([](const std::string&, const Filter& f) {
        double total = integrate(f, [&](Vec2 p) { return std::abs(f.eval(p)); });
        Vec2 r = f.radius();
        EXPECT_GT(chi_square_2d([&](Vec2 u) { return f.sample(u).offset; },
                                [&](Vec2 p) { return std::abs(f.eval(p)) / total; }, {-r.x, r.x, -r.y, r.y},
                                200000, 32, 8),
                  p_threshold);
    });
}

// E[w g(x)] must be the integral of f g over that of f: for g = 1 and for one that tells left from right and
// up from down.
TEST(FilterConformance, WeightsMakeUpTheFilteredValue) {
    for_each_filter([](const std::string&, const Filter& f) {
        constexpr int n = 512; // points a side; a regular grid, so that the error is that of the tables
        double mean = 0, moment = 0;
        auto g = [](Vec2 p) { return static_cast<double>(p.x * p.x + 0.5f * p.y * p.y + 0.25f * p.x * p.y); };
        double largest = 0;
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                FilterSample s =
                    f.sample({(static_cast<float>(x) + .5f) / n, (static_cast<float>(y) + .5f) / n});
                ASSERT_LE(std::abs(s.offset.x), f.radius().x);
                ASSERT_LE(std::abs(s.offset.y), f.radius().y);
                mean += s.weight;
                moment += s.weight * g(s.offset);
                largest = std::max(largest, std::abs(static_cast<double>(s.weight)));
            }
        mean /= n * n;
        moment /= n * n;
        const double integral = integrate(f, [&](Vec2 p) { return f.eval(p); });
        const double expected_moment = integrate(f, [&](Vec2 p) { return f.eval(p) * g(p); }) / integral;
        EXPECT_NEAR(mean, 1, 0.01 * largest);
        const double reach = static_cast<double>(dot(f.radius(), f.radius()));
        EXPECT_NEAR(moment, expected_moment, 0.01 * largest * reach);
    });
}

TEST(FilterConformance, ParametersAreChecked) {
    for (const Kind<Filter>& kind : filter_kinds().all()) {
        EXPECT_EQ(testing_support::messages_of(filter_kinds(), kind.name, {make_float("xradius", 0)}).size(),
                  1u);
        EXPECT_EQ(testing_support::messages_of(filter_kinds(), kind.name, {make_float("yradius", -1)}).size(),
                  1u);
    }
}

} // namespace
} // namespace alhazen
