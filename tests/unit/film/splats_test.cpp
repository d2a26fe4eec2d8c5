// Light brought to any place of the film: spread by the filter, none lost and none made, the same bits from
// any threads.
#include "film/splats.h"

#include <cstring>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "base/threads.h"
#include "film/film.h"
#include "tests/support/family.h"

namespace alhazen {
namespace {

std::unique_ptr<Film> make_splat_film(std::vector<Parameter> more = {}) {
    std::vector<Parameter> parameters{make_integer("xresolution", 20), make_integer("yresolution", 16)};
    for (Parameter& p : more) parameters.push_back(std::move(p));
    return testing_support::make_member(film_kinds(), "rgb", parameters);
}

TEST(Splats, AreTheFilterAroundTheirPlace) {
    auto visit = [](const std::string&, const std::string&, const Filter& filter) {
        const Rect2i pixels{{2, 3}, {42, 38}};
        Splats splats(pixels, filter);
        const Vec2 place{22.3f, 21.8f};
        splats.add(place, {1, 2, 4});
        double largest = 0;
        for (int y = 3; y < 38; ++y)
            for (int x = 2; x < 42; ++x) {
                const Vec3d sum = splats.sum(static_cast<std::size_t>((y - 3) * 40 + x - 2));
                const Vec2 offset = place - Vec2(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
                const double expected = static_cast<double>(filter.eval(offset) / filter.integral());
                largest = std::max(largest, std::abs(expected));
                // The curves are cut into 256 steps.
                EXPECT_NEAR(sum.x, expected, 0.03) << x << " " << y;
                EXPECT_NEAR(sum.z, 4 * sum.x, 1e-12);
            }
        EXPECT_GT(largest, 0.01);
    };
    testing_support::for_each_example(filter_kinds(), visit);
}

TEST(Splats, KeepTheLight) {
    auto visit = [](const std::string&, const std::string&, const Filter& filter) {
        Splats splats({{0, 0}, {40, 40}}, filter);
        Rng rng(1);
        constexpr int n = 20000;
        for (int i = 0; i < n; ++i) splats.add({20 + rng.uniform(), 20 + rng.uniform()}, {1, 1, 1});
        double sum = 0;
        for (std::size_t i = 0; i < 40 * 40; ++i) sum += splats.sum(i).x / n;
        EXPECT_NEAR(sum, 1, 0.02);
    };
    testing_support::for_each_example(filter_kinds(), visit);
}

TEST(Splats, OutsideThePictureTouchItsRimOrNothing) {
    auto filter = testing_support::make_member(filter_kinds(), "box", {make_float("xradius", 1.5f)});
    Splats splats({{0, 0}, {4, 4}}, *filter);
    EXPECT_TRUE(splats.reaches({-0.9f, 2}));
    EXPECT_FALSE(splats.reaches({-1.1f, 2}));
    EXPECT_FALSE(splats.reaches({2, -0.1f}));
    EXPECT_TRUE(splats.reaches({4.9f, 2}));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(splats.reaches({nan, 2}));
    for (Vec2 p : {Vec2(-0.9f, 2.2f), Vec2(1e30f, 0), Vec2(-infinity, 1), Vec2(2, nan)})
        splats.add(p, {1, 1, 1});
    double sum = 0;
    for (std::size_t i = 0; i < 16; ++i) sum += splats.sum(i).x;
    EXPECT_NEAR(sum, 1 / 3.0, 0.01);
    EXPECT_NEAR(splats.sum(8).x, 1 / 3.0, 0.01);
}

TEST(Film, ShowsSplatsBesideSamples) {
    auto film = make_splat_film();
    auto filter = testing_support::make_member(filter_kinds(), "box", {});
    film->start(ColorMode::rgb);
    film->start_splats(*filter);
    film->add({3, 4}, Spectrum(1), Wavelengths::rgb(), 1);
    for (int i = 0; i < 8; ++i) {
        film->add_splat({3.5f, 4.5f}, Spectrum(1), Wavelengths::rgb());
        film->add_splat({7.5f, 9.5f}, Spectrum(3), Wavelengths::rgb());
    }
    film->set_splat_scale(0.25);
    EXPECT_NEAR(film->image().rgb(3, 4).y, 3, 1e-6f);
    EXPECT_NEAR(film->image().rgb(7, 9).y, 6, 1e-6f);
    EXPECT_EQ(film->image().rgb(0, 0).y, 0);
    film->start(ColorMode::rgb);
    EXPECT_EQ(film->image().rgb(7, 9).y, 0);
    EXPECT_FALSE(film->splat_reaches({3, 3}));
}

TEST(Film, LimitsSplatsAsItDoesSamples) {
    auto film = make_splat_film({make_float("maxcomponentvalue", 2)});
    film->start(ColorMode::rgb);
    film->start_splats(*testing_support::make_member(filter_kinds(), "box", {}));
    film->add_splat({3.5f, 4.5f}, Spectrum(8, 4, 4, 5), Wavelengths::rgb());
    EXPECT_NEAR(film->image().rgb(3, 4).x, 2, 1e-6f);
    EXPECT_NEAR(film->image().rgb(3, 4).y, 1, 1e-6f);
}

TEST(Film, SplatsGiveTheSameBitsFromAnyThreads) {
    auto filter = testing_support::make_member(filter_kinds(), "mitchell", {});
    auto splatted = [&](int threads) {
        auto film = make_splat_film();
        film->start(ColorMode::rgb);
        film->start_splats(*filter);
        with_threads(threads, [&] {
            parallel_for(5000, 3, [&](std::size_t i) {
                Rng rng(i);
                const Vec2 p{rng.uniform() * 20, rng.uniform() * 16};
                film->add_splat(p, Spectrum(std::exp(20 * rng.uniform() - 10)), Wavelengths::rgb());
            });
        });
        return film->image();
    };
    const Image one = splatted(1), four = splatted(4);
    EXPECT_EQ(std::memcmp(one.values().data(), four.values().data(), one.values().size_bytes()), 0);
}

} // namespace
} // namespace alhazen
