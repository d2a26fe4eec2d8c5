// Lenses against the formulas of geometrical optics and against the patent of one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/file.h"
#include "base/hash.h"
#include "cameras/aperture_mask.h"
#include "cameras/lens_system.h"

namespace alhazen {
namespace {

using testing::HasSubstr;

LensSystem double_gauss() {
    return LensSystem(parse_lens(read_file(ALHAZEN_SOURCE_DIR "/scenes/lenses/double-gauss-50mm.txt")));
}

std::string error_of(const std::string& text) {
    try {
        parse_lens(text);
    } catch (const std::runtime_error& e) {
        return e.what();
    }
    return "";
}

TEST(LensFile, IsReadInMetres) {
    const auto surfaces = parse_lens("# a lens\r\n\n 20\t3.5 1.5 10 # front\r\n-2e1 4 0 10\r\n+0 1 0 8");
    ASSERT_EQ(surfaces.size(), 3u);
    EXPECT_DOUBLE_EQ(surfaces[0].radius, 0.02);
    EXPECT_DOUBLE_EQ(surfaces[0].thickness, 0.0035);
    EXPECT_EQ(surfaces[0].eta, 1.5);
    EXPECT_DOUBLE_EQ(surfaces[0].opening, 0.005);
    EXPECT_DOUBLE_EQ(surfaces[1].radius, -0.02);
    EXPECT_EQ(surfaces[1].eta, 1);
    EXPECT_TRUE(surfaces[2].is_stop());
}

TEST(LensFile, SaysInWhichLineWhatIsWrong) {
    EXPECT_EQ(error_of("20 3 1.5 10\n# x\n20 3 1\n"),
              "line 3: there are 3 numbers; expected 4: radius, thickness, refractive index, diameter");
    EXPECT_EQ(error_of("20 3 1.5 10 7"),
              "line 1: there are 5 numbers; expected 4: radius, thickness, refractive index, diameter");
    EXPECT_EQ(error_of("20 3 1,5 10"), "line 1: \"1,5\" is not a number");
    EXPECT_EQ(error_of("20 nan 1.5 10"), "line 1: \"nan\" is not a number");
    EXPECT_EQ(error_of("20 1e999 1.5 10"), "line 1: \"1e999\" is not a number");
    EXPECT_EQ(error_of("\n20 -3 1.5 10"), "line 2: the thickness is -3; it must not be negative");
    EXPECT_EQ(error_of("20 3 0.9 10"),
              "line 1: the refractive index is 0.9; it must be at least 1, or 0 for air");
    EXPECT_EQ(error_of("20 3 1.5 0"), "line 1: the diameter is 0; it must be above 0");
    EXPECT_THAT(error_of("0 3 1 5\n0 3 1 5"), HasSubstr("line 2: a second aperture stop"));
    EXPECT_THAT(error_of("20 3 1.5 10\n0 3 1 5"),
                HasSubstr("line 2: the aperture stop (radius 0) does not refract"));
    EXPECT_THAT(error_of("20 3 1.5 10\n# end\n"),
                HasSubstr("line 1: the refractive index behind the last surface"));
    EXPECT_THAT(error_of("# nothing\n"), HasSubstr("there is no lens in it"));
}

// The lensmaker's formula for a thick lens, and where its principal planes lie (Hecht 2017, section 6.1).
TEST(LensSystem, HasTheLensmakersFocalLength) {
    const double r1 = 0.06, r2 = -0.09, n = 1.6, d = 0.012;
    LensSystem lens({{r1, d, n, 0.01}, {r2, 0.07, 1, 0.01}});
    const double f = 1 / ((n - 1) * (1 / r1 - 1 / r2 + (n - 1) * d / (n * r1 * r2)));
    const ThickLens thick = lens.thick_lens();
    EXPECT_NEAR(thick.focal_length, f, 1e-12);
    EXPECT_NEAR(thick.rear_principal, 0.07 + f * (n - 1) * d / (n * r1), 1e-12);
    EXPECT_NEAR(thick.front_principal, 0.07 + d + f * (n - 1) * d / (n * r2), 1e-12);
}

TEST(LensSystem, TheDoubleGaussIsThatOfThePatent) {
    const LensSystem lens = double_gauss();
    const ThickLens thick = lens.thick_lens();
    EXPECT_NEAR(thick.focal_length, 0.05, 0.05e-3);
    // The back focus is 0.71436 f; the file has it as the way to the film, which is then focused at infinity.
    EXPECT_NEAR(lens.rear_z() - (thick.rear_principal - thick.focal_length), 0.71436 * 0.05, 0.05e-3);
    EXPECT_NEAR(lens.rear_z(), 0.71436 * 0.05, 1e-6);
    ASSERT_NE(lens.stop(), nullptr);
    EXPECT_DOUBLE_EQ(lens.stop()->opening, 8.55e-3);
}

// A sphere of glass has a point inside, R / n from its centre, whose light seems to come from n R behind the
// centre, at any angle and exactly (Weierstrass 1856).
TEST(LensSystem, RefractsExactly) {
    const double radius = 0.01, n = 1.5;
    const LensSystem lens({{radius, radius + radius / n, n, radius}});
    int passed = 0;
    for (int i = 0; i < 80; ++i) {
        const double angle = i * 3.14159265358979 / 180;
        const auto ray = lens.trace({}, {0.6 * std::sin(angle), 0.8 * std::sin(angle), std::cos(angle)});
        if (!ray) continue;
        ++passed;
        const Vec3d seen = ray->o + ray->d * ((radius / n - n * radius - ray->o.z) / ray->d.z);
        EXPECT_NEAR(length(seen - Vec3d(0, 0, radius / n - n * radius)), 0, 1e-14);
        EXPECT_NEAR(length(ray->d), 1, 1e-14);
    }
    EXPECT_GT(passed, 50);
}

TEST(LensSystem, StopsRays) {
    LensSystem lens({{0, 0.01, 1, 0.002}});
    EXPECT_TRUE(lens.trace({}, {0.0019, 0, 0.01}));
    EXPECT_FALSE(lens.trace({}, {0.0021, 0, 0.01}));
    lens.set_stop(0.001);
    EXPECT_FALSE(lens.trace({}, {0.0019, 0, 0.01}));
    // Past the edge of the glass, and totally reflected in it.
    const LensSystem glass({{0.01, 0.01, 1.5, 0.004}});
    EXPECT_TRUE(glass.trace({}, {0.0039, 0, 0.01}));
    EXPECT_FALSE(glass.trace({}, {0.0045, 0, 0.01}));
    EXPECT_FALSE(LensSystem({{0.01, 0.012, 2, 0.01}}).trace({0.0055, 0, 0.01}, {0, 0, 1}));
}

TEST(LensSystem, RaysOfAFilmPointMeetAtTheFocusDistance) {
    for (double distance : {0.5, 2.0, 50.0}) {
        LensSystem lens = double_gauss();
        ASSERT_EQ(lens.focus(distance), "");
        EXPECT_GT(lens.rear_z(), 0.0357);
        for (double x : {-0.001, 0.0005, 0.001}) {
            const auto ray = lens.trace({}, {x, 0, lens.rear_z()});
            ASSERT_TRUE(ray);
            const double crossing = ray->o.z - ray->d.z * ray->o.x / ray->d.x;
            EXPECT_NEAR(crossing / distance, 1, 0.001 + 0.002 * distance);
        }
        // 5 mm from the axis, at f/25: the thin lens' magnification.
        lens.set_stop(0.001);
        const ThickLens thick = lens.thick_lens();
        const double magnification = (distance - thick.front_principal) / thick.rear_principal;
        for (double y : {-0.0015, 0.0, 0.0015}) {
            const auto ray = lens.trace({0.005, 0, 0}, {-0.005, y, 0.05});
            if (!ray) continue;
            const Vec3d p = ray->o + ray->d * ((distance - ray->o.z) / ray->d.z);
            EXPECT_NEAR(-p.x / (0.005 * magnification), 1, 0.01);
            EXPECT_NEAR(p.y / (0.005 * magnification), 0, 0.01);
        }
    }
}

TEST(LensSystem, SaysWhereItCannotFocus) {
    LensSystem lens = double_gauss();
    EXPECT_THAT(lens.focus(0.1), HasSubstr("cannot be focused at 0.1 m; the nearest that it can is 0.19"));
    EXPECT_EQ(lens.focus(0.21), "");
    LensSystem diverging({{-0.05, 0.002, 1.5, 0.01}, {0.05, 0.05, 1, 0.01}});
    EXPECT_THAT(diverging.focus(1), HasSubstr("does not bring light together"));
    LensSystem window({{0, 0.05, 1, 0.01}});
    EXPECT_THAT(window.focus(1), HasSubstr("does not bring light together"));
}

// What arrives at a place of the film under a sky of radiance 1, by a fine grid over all of the last
// surface's plane and by the exit pupil's samples.
TEST(ExitPupil, SamplesAllLightThatArrives) {
    for (double stop : {0.00855, 0.002}) {
        LensSystem lens = double_gauss();
        lens.set_stop(stop);
        ASSERT_EQ(lens.focus(1), "");
        constexpr double film_radius = 0.0216;
        const ExitPupil pupil(lens, film_radius);
        auto arriving = [&](Vec2d film, Vec3d p) {
            const Vec3d from{film.x, film.y, 0}, d = p - from;
            if (!lens.trace(from, d)) return 0.0;
            const double cosine = d.z / length(d);
            return std::pow(cosine, 4) / (d.z * d.z);
        };
        for (Vec2d film : {Vec2d(0, 0), Vec2d(0.003, -0.004), Vec2d(-0.012, 0.009), Vec2d(0.018, 0.0119)}) {
            constexpr int n = 300;
            const double side = 3 * lens.rear_opening(), cell = side / n;
            double all = 0;
            for (int y = 0; y < n; ++y)
                for (int x = 0; x < n; ++x)
                    all += arriving(
                        film, {(x + 0.5) * cell - side / 2, (y + 0.5) * cell - side / 2, lens.rear_z()});
            all *= cell * cell;
            double sampled = 0;
            int passed = 0;
            for (int y = 0; y < n; ++y)
                for (int x = 0; x < n; ++x) {
                    const Vec2 u{(static_cast<float>(x) + 0.5f) / n, (static_cast<float>(y) + 0.5f) / n};
                    const auto s = pupil.sample(film, u);
                    ASSERT_TRUE(s);
                    const double e = arriving(film, s->p) * s->area;
                    sampled += e / (n * n);
                    passed += e > 0;
                }
            EXPECT_NEAR(sampled / all, 1, stop < 0.005 ? 0.01 : 0.005);
            // Of a rectangle around an ellipse pi / 4 is inside; vignetting and margins leave less.
            EXPECT_GT(passed, 0.3 * n * n);
            // In the middle: that of a lens of f/2, or narrower by the stop.
            if (film.x == 0) {
                const double sine = stop / 0.00855 / 4 * (1 - 0.05);
                EXPECT_NEAR(all / (3.14159 * sine * sine), 1, 0.06);
            }
        }
    }
}

TEST(ExitPupil, IsNowhereWhereNoLightArrives) {
    // A tube: only the middle of the film is lit.
    const LensSystem tube({{0, 0.05, 1, 0.001}, {0, 0.001, 1, 0.001}});
    const ExitPupil pupil(tube, 0.1);
    EXPECT_TRUE(pupil.sample({0, 0}, {0.5f, 0.5f}));
    EXPECT_FALSE(pupil.sample({0.09, 0}, {0.5f, 0.5f}));
}

TEST(ApertureMask, ShapesLetThroughWhatARoundHoleDoes) {
    for (const char* name : {"gaussian", "square", "pentagon", "star"}) {
        const auto mask = ApertureMask::named(name);
        ASSERT_TRUE(mask);
        constexpr int n = 700;
        double sum = 0, farthest = 0;
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const Vec2d p{(x + 0.5) * 3 / n - 1.5, (y + 0.5) * 3 / n - 1.5};
                const double value = mask->at(p);
                sum += value * 9 / (n * n);
                if (value > 0) farthest = std::max(farthest, length(p));
            }
        EXPECT_NEAR(sum, 3.14159, 0.01) << name;
        EXPECT_LE(farthest, mask->reach()) << name;
        EXPECT_GT(farthest, mask->reach() - 0.03) << name;
    }
    EXPECT_FALSE(ApertureMask::named("circle"));
    // A corner down; a point to the left; half as wide as the hole.
    EXPECT_GT(ApertureMask::named("pentagon")->at({0, -0.75}), 0);
    EXPECT_EQ(ApertureMask::named("pentagon")->at({0, 0.75}), 0);
    EXPECT_GT(ApertureMask::named("square")->at({0.49, -0.49}), 0);
    EXPECT_EQ(ApertureMask::named("square")->at({0.51, 0}), 0);
    EXPECT_GT(ApertureMask::named("star")->at({-0.9, 0}), 0);
    EXPECT_EQ(ApertureMask::named("star")->at({0.9, 0}), 0);
}

TEST(ApertureMask, PicturesStandUpright) {
    Image image = Image::rgb_image(2, 2);
    image.set_rgb(1, 0, {3, 0, 0}); // upper right
    const ApertureMask mask(image);
    EXPECT_NEAR(mask.at({0.5, 0.5}), 3.14159, 1e-5);
    EXPECT_NEAR(mask.at({0, 0.5}), 3.14159 / 2, 1e-5);
    EXPECT_EQ(mask.at({-0.5, -0.5}), 0);
    EXPECT_EQ(mask.at({1.01, 0.5}), 0);
    image.set_rgb(0, 0, {-1, 0, 0});
    EXPECT_THROW(ApertureMask{image}, std::runtime_error);
    EXPECT_THROW(ApertureMask{Image::grey_image(3, 3)}, std::runtime_error);
}

} // namespace
} // namespace alhazen
