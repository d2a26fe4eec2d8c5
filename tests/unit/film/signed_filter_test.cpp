// Filters with negative lobes on the film: few samples give sensible pixels, many the filtered picture.
#include <gtest/gtest.h>

#include "base/hash.h"
#include "film/film.h"
#include "film/filter.h"
#include "tests/support/family.h"

namespace alhazen {
namespace {

constexpr int side = 48;

/// A film of side x side pixels that see the same picture around their centres, given by a function of the
/// offset, spp independent samples each.
template <class Picture>
Image filtered(const Filter& filter, int spp, Picture picture) {
    auto film = testing_support::make_member(
        film_kinds(), "rgb", {make_integer("xresolution", side), make_integer("yresolution", side)});
    film->start(ColorMode::rgb);
    Rng rng(7);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            for (int s = 0; s < spp; ++s) {
                float u = rng.uniform(), v = rng.uniform();
                FilterSample place = filter.sample({u, v});
                film->add({x, y}, Spectrum(picture(place.offset)), Wavelengths::rgb(), place.weight);
            }
    return film->image();
}

// Samples 1, 2, 4, 3 with weights 1, 1, 3, -2: of the mean 2.5 and the mean weight 3/4 the covariance is
// (1 + 2 + 12 - 6) / 4 - 2.5 * 3/4 = 0.375. A picture started anew knows nothing of it.
TEST(FilmWeights, MayBeOtherThanOneFromTheMiddleOn) {
    auto film = testing_support::make_member(
        film_kinds(), "rgb", {make_integer("xresolution", 2), make_integer("yresolution", 1)});
    film->start(ColorMode::rgb);
    for (auto [value, weight] : {std::pair{1.0f, 1.0f}, {2.0f, 1.0f}, {4.0f, 3.0f}, {3.0f, -2.0f}})
        film->add({1, 0}, Spectrum(value), Wavelengths::rgb(), weight);
    EXPECT_NEAR(film->image().rgb(1, 0)[0], 2.875f, 1e-5f);
    film->start(ColorMode::rgb);
    film->add({1, 0}, Spectrum(5.0f), Wavelengths::rgb(), 1);
    EXPECT_NEAR(film->image().rgb(1, 0)[0], 5, 1e-5f);
    film->add({1, 0}, Spectrum(7.0f), Wavelengths::rgb(), 3);
    EXPECT_NEAR(film->image().rgb(1, 0)[0], 7, 1e-5f); // 6 + (5 + 21) / 2 - 6 * 2
}

struct SignedFilter : testing::TestWithParam<const char*> {
    std::unique_ptr<Filter> filter = testing_support::make_member(filter_kinds(), GetParam(), {});
};

TEST_P(SignedFilter, ConstantPicturesStayConstant) {
    for (int spp : {1, 2, 4, 16}) {
        Image image = filtered(*filter, spp, [](Vec2) { return 0.75f; });
        for (float v : image.values()) ASSERT_NEAR(v, 0.75f, 1e-5f);
    }
}

// The covariance of a picture in 0 ... 1 with weights in -k ... k is at most k / 2.
TEST_P(SignedFilter, FewSamplesDoNotBlowUp) {
    float k = std::abs(filter->sample({0.5f, 0.5f}).weight);
    Image image = filtered(*filter, 4, [](Vec2 p) { return p.x > 0.3f ? 1.0f : 0.0f; });
    for (float v : image.values()) {
        ASSERT_LE(v, 1 + 0.5f * k);
        ASSERT_GE(v, -0.5f * k);
    }
}

// The mean over pixels is the filtered picture but for the bias of (plain mean - filtered) / spp.
TEST_P(SignedFilter, ManySamplesGiveTheFilteredPicture) {
    auto edge = [](Vec2 p) { return p.x + 0.5f * p.y > 0.3f ? 1.0f : 0.0f; };
    constexpr int n = 1000;
    double sum = 0, integral = 0;
    Vec2 r = filter->radius();
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            Vec2 p{r.x * (2 * (static_cast<float>(x) + .5f) / n - 1),
                   r.y * (2 * (static_cast<float>(y) + .5f) / n - 1)};
            double f = static_cast<double>(filter->eval(p));
            integral += f;
            sum += f * static_cast<double>(edge(p));
        }
    constexpr int spp = 64;
    double mean = 0, square = 0;
    Image image = filtered(*filter, spp, edge);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            auto v = static_cast<double>(image.at(x, y));
            mean += v / (side * side);
            square += v * v / (side * side);
        }
    // False alarms: 5 standard errors, less than one in a million.
    double error = std::sqrt((square - mean * mean) / (side * side));
    EXPECT_NEAR(mean, sum / integral, 5 * error + 1.0 / spp);
    EXPECT_LT(error, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Kinds, SignedFilter, testing::Values("mitchell", "sinc", "gaussian"),
                         [](const auto& test) { return std::string(test.param); });

// Half a pixel is a step here, so that only negative lobes of so narrow a window are met.
TEST(Filters, WithoutAPositiveIntegralAreErrors) {
    EXPECT_EQ(testing_support::messages_of(filter_kinds(), "sinc", {}).size(), 0u);
    EXPECT_EQ(testing_support::messages_of(filter_kinds(), "sinc",
                                           {make_float("xradius", 64), make_float("tau", 1 / 6.0f)})
                  .size(),
              1u);
}

} // namespace
} // namespace alhazen
