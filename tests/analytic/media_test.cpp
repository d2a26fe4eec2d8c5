/// Participating media against closed forms, and the two integrators that see them against each other.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "image/codec.h"
#include "tests/support/effort.h"
#include "tests/support/render_scene.h"
#include "tests/support/statistics.h"

namespace alhazen::testing {
namespace {

using testing_support::fewer_if_sanitized;

// Parallel rays along +z through the middle of a box of 2 x 2 x 2, from in front of it.
std::string through_the_box(const std::string& integrator, int spp, const std::string& medium,
                            const std::string& lights) {
    return integrator + fmt::format(R"(
Sampler "independent" "integer pixelsamples" {}
PixelFilter "box"
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
LookAt 0 0 -5  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [ -.01 .01 -.01 .01 ]
WorldBegin
{}
MakeNamedMedium "matter" {}
Material "interface"
MediumInterface "matter" ""
Shape "trianglemesh" "point3 P" [ -1 -1 -1  1 -1 -1  -1 1 -1  1 1 -1  -1 -1 1  1 -1 1  -1 1 1  1 1 1 ]
  "integer indices" [ 0 2 1 1 2 3  4 5 6 5 7 6  0 1 4 1 5 4  2 6 3 3 6 7  0 4 2 2 4 6  1 3 5 3 7 5 ]
)",
                                    spp, lights, medium);
}

const char* const volpath = R"(Integrator "volpath" "integer maxdepth" 100)";

// Means of the three channels, with their standard errors over seeds.
struct Measured {
    std::array<Moments, 3> channel;
};

Measured measure(const std::string& text, ColorMode mode, int seeds = 8) {
    std::array<std::vector<double>, 3> means;
    for (int seed = 0; seed < seeds; ++seed) {
        RenderSettings settings;
        settings.seed = static_cast<std::uint64_t>(seed);
        settings.color = mode;
        const Image image = render_text(text, settings).image;
        for (std::size_t c = 0; c < 3; ++c) means[c].push_back(mean_of(image, static_cast<int>(c)));
    }
    Measured measured;
    for (std::size_t c = 0; c < 3; ++c) measured.channel[c] = moments(means[c]);
    return measured;
}

// Seven standard errors of the mean of 8 seeds: a false-alarm rate below 3e-4 a comparison, seeds fixed.
void expect_means(const Measured& measured, Vec3 expected, double own_error = 1e-4) {
    for (std::size_t c = 0; c < 3; ++c) {
        const Moments& m = measured.channel[c];
        const double error = std::sqrt(m.variance_of_mean);
        EXPECT_NEAR(m.mean, static_cast<double>(expected[static_cast<int>(c)]), 7 * error + own_error)
            << "channel " << c;
    }
}

TEST(MediaClosedForm, AbsorptionIsBeersLaw) {
    const std::string medium =
        R"("string type" "homogeneous" "rgb sigma_a" [ .2 .5 1.5 ] "rgb sigma_s" [ 0 0 0 ])";
    const Measured measured = measure(through_the_box(volpath, 64, medium, white_sky), ColorMode::rgb);
    expect_means(measured, {std::exp(-0.4f), std::exp(-1.0f), std::exp(-3.0f)});
}

// What the same matter everywhere lets through towards a light is known, and no chance has a part in it: one
// sample shows it. The camera is behind the box, and sees a floor that is lit through it.
TEST(MediaClosedForm, LightComesThroughHomogeneousMatterWithoutNoise) {
    const std::string medium =
        R"("string type" "homogeneous" "rgb sigma_a" [ .1 .3 1 ] "rgb sigma_s" [ .1 .2 .5 ])";
    std::string text = through_the_box(R"(Integrator "volpath" "integer maxdepth" 1)", 1, medium,
                                       R"(LightSource "distant" "point3 from" [ 0 0 -1 ])");
    text.replace(text.find("LookAt 0 0 -5"), 13, "LookAt 0 0 1.5");
    text.replace(text.find("  0 0 0  0 1 0"), 14, "  0 0 2  0 1 0");
    text += R"(MediumInterface "" ""
Material "diffuse" "rgb reflectance" [ .5 .5 .5 ]
Shape "bilinearmesh" "point3 P" [ -1 -1 2  1 -1 2  -1 1 2  1 1 2 ]
)";
    RenderSettings settings;
    settings.color = ColorMode::rgb;
    const Image image = render_text(text, settings).image;
    const Vec3 expected = Vec3{std::exp(-0.4f), std::exp(-1.0f), std::exp(-3.0f)} * (0.5f * inv_pi);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.rgb(x, y)[c] / expected[c], 1, 1e-4f);
}

// Fog without end, which red light does not notice: half of the sky's comes back from the floor, found by
// leaving the fog and by light sampling, of which only the other colours see how far away the sky is taken to
// be.
TEST(MediaClosedForm, SkyBeyondEndlessMatterThatIsClearInOneChannel) {
    for (const char* compensate : {"true", "false"}) {
        const std::string text = fmt::format(R"(
Integrator "volpath" "integer maxdepth" 2
Sampler "independent" "integer pixelsamples" 1024
PixelFilter "box"
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ 0 .5 2 ] "rgb sigma_s" [ 0 0 0 ]
MediumInterface "" "fog"
LookAt 0 0 1.5  0 0 2  0 1 0
Camera "orthographic" "float screenwindow" [ -.01 .01 -.01 .01 ]
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ] "bool compensate" {}
MediumInterface "fog" "fog"
Material "diffuse" "rgb reflectance" [ .5 .5 .5 ]
Shape "bilinearmesh" "point3 P" [ -1 -1 2  1 -1 2  -1 1 2  1 1 2 ]
)",
                                             compensate);
        const Moments red = measure(text, ColorMode::rgb).channel[0];
        EXPECT_NEAR(red.mean, 0.5, 7 * std::sqrt(red.variance_of_mean)) << compensate;
    }
}

// One sample fades out to half of itself at the box's faces: three quarters of it, on average, through the
// middle.
TEST(MediaClosedForm, AbsorptionOfAGridOfOneCell) {
    const std::string medium =
        R"("string type" "uniformgrid" "float density" [ 1.6 ] "point3 p0" [ -1 -1 -1 ] "point3 p1" [ 1 1 1 ]
                                   "rgb sigma_a" [ .2 .5 1 ] "rgb sigma_s" [ 0 0 0 ])";
    const Measured measured = measure(through_the_box(volpath, 64, medium, white_sky), ColorMode::rgb);
    const float depth = 1.6f * 2 * 0.75f;
    expect_means(measured, {std::exp(-0.2f * depth), std::exp(-0.5f * depth), std::exp(-depth)}, 1e-3);
}

// A scaled medium is larger, and as dense as before: coefficients are per length of the world.
TEST(MediaClosedForm, ScalingAGridLeavesItsDensity) {
    const std::string medium =
        R"("string type" "uniformgrid" "float density" [ 1 ] "point3 p0" [ -.5 -.5 -.5 ] "point3 p1" [ .5 .5 .5 ]
                                   "rgb sigma_a" [ 1 1 1 ] "rgb sigma_s" [ 0 0 0 ])";
    std::string text = through_the_box(volpath, 64, medium, white_sky);
    text.insert(text.find("MakeNamedMedium"), "AttributeBegin Scale 2 2 2\n");
    text.insert(text.find("Material \"interface\""), "AttributeEnd\n");
    expect_means(measure(text, ColorMode::rgb), Vec3(std::exp(-2 * 0.75f)), 1e-3);
}

TEST(MediaClosedForm, EmissionWithoutScattering) {
    const std::string medium =
        R"("string type" "homogeneous" "rgb sigma_a" [ .3 .6 .9 ] "rgb sigma_s" [ 0 0 0 ] "rgb Le" [ 1 1 1 ] "float Lescale" 2)";
    const Measured measured = measure(through_the_box(volpath, 64, medium, ""), ColorMode::rgb);
    expect_means(measured, {2 * (1 - std::exp(-0.6f)), 2 * (1 - std::exp(-1.2f)), 2 * (1 - std::exp(-1.8f))});
}

// Where nothing is absorbed and light is the same all around, nobody sees the medium.
TEST(MediaClosedForm, WhiteFurnace) {
    for (
        const char* medium :
        {R"("string type" "homogeneous" "rgb sigma_a" [ 0 0 0 ] "rgb sigma_s" [ .5 2 4 ] "float g" .4)",
         R"("string type" "uniformgrid" "integer nx" 2 "integer nz" 2 "float density" [ 1 4 2 0 ] "float g" -.3
             "point3 p0" [ -1 -1 -1 ] "point3 p1" [ 1 1 1 ] "rgb sigma_a" [ 0 0 0 ] "rgb sigma_s" [ 1 2 1 ])",
         R"("string type" "rgbgrid" "integer nx" 2 "rgb sigma_s" [ 1 2 3 3 .1 1 ] "rgb sigma_a" [ 0 0 0 0 0 0 ]
             "point3 p0" [ -1 -1 -1 ] "point3 p1" [ 1 1 1 ])",
         R"("string type" "cloud" "rgb sigma_a" [ 0 0 0 ] "rgb sigma_s" [ 2 2 2 ] "point3 p0" [ -1 -1 -1 ] "point3 p1" [ 1 1 1 ])"}) {
        SCOPED_TRACE(medium);
        // Found by the phase function alone, and by light sampling, too.
        for (const char* sky :
             {white_sky, R"(LightSource "infinite" "rgb L" [ 1 1 1 ] "bool compensate" false)"})
            for (const ColorMode mode : {ColorMode::rgb, ColorMode::spectral})
                expect_means(measure(through_the_box(volpath, 32, medium, sky), mode), Vec3(1), 2e-3);
    }
}

TEST(MediaUnseen, IntegratorsThatLeaveThemOutSaySo) {
    const std::string medium = R"("string type" "homogeneous")";
    for (const std::string name : {"lightpath", "path", "simplepath", "randomwalk", "sppm", "volpath",
                                   "simplevolpath", "bdpt", "mlt"}) {
        SCOPED_TRACE(name);
        Messages messages;
        const std::string text = through_the_box("\nIntegrator \"" + name + "\"", 1, medium, white_sky);
        auto world = build_world(read_pbrt_string(text, ".", messages), {}, messages);
        std::string told;
        for (const Message& m : messages.list()) told += m.full_text() + "\n";
        if (world->integrator->sees_media())
            EXPECT_EQ(told, "");
        else
            EXPECT_THAT(told, ::testing::HasSubstr(":2:1: warning: integrator \"" + name +
                                                   "\" does not see participating media"));
    }
}

const char* const bright_sky = R"(
LightSource "infinite" "rgb L" [ .2 .3 .5 ]
AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 9 8 7 ]
Translate 1.5 1.5 -1.5
Shape "sphere" "float radius" .7
AttributeEnd
)";

// As through_the_box, all of it in view.
std::string whole_box(const std::string& integrator, int spp, const std::string& medium,
                      const std::string& lights) {
    std::string text = through_the_box(integrator, spp, medium, lights);
    return text.replace(text.find("[ -.01 .01 -.01 .01 ]"), 21, "[ -1.2 1.2 -1.2 1.2 ]");
}

std::vector<double> means_of_seeds(const std::string& text, ColorMode mode) {
    std::vector<double> list;
    for (int seed = 0; seed < 16; ++seed) {
        RenderSettings settings;
        settings.seed = static_cast<std::uint64_t>(seed);
        settings.color = mode;
        const Image image = render_text(text, settings).image;
        list.push_back((mean_of(image, 0) + mean_of(image, 1) + mean_of(image, 2)) / 3);
    }
    return list;
}

// Welch's t-test over 16 seeds, |t| < 7.
TEST(MediaAgreement, LightSamplingOrNot) {
    for (
        const std::string medium :
        {R"("string type" "homogeneous" "rgb sigma_a" [ .05 .2 .6 ] "rgb sigma_s" [ 1 .7 .4 ] "float g" .5)",
         R"("string type" "uniformgrid" "integer nx" 2 "integer nz" 2 "float density" [ 1 3 2 0 ] "rgb sigma_a" [ .1 .2 .3 ]
             "point3 p0" [ -1 -1 -1 ] "point3 p1" [ 1 1 1 ] "rgb sigma_s" [ 1 .5 1 ] "rgb Le" [ .5 .2 .1 ])"})
        for (const std::string border :
             {"Material \"interface\"", "Material \"dielectric\" \"float roughness\" .2"})
            for (const ColorMode mode : {ColorMode::rgb, ColorMode::spectral}) {
                SCOPED_TRACE(border + " " + medium);
                auto means = [&](const char* integrator, int spp) {
                    std::string text = whole_box(integrator, spp, medium, bright_sky);
                    text.replace(text.find("Material \"interface\""), 20, border);
                    return means_of_seeds(text, mode);
                };
                EXPECT_LT(
                    std::abs(t_between(
                        means(R"(Integrator "simplevolpath" "integer maxdepth" 12)", fewer_if_sanitized(256)),
                        means(R"(Integrator "volpath" "integer maxdepth" 12)", fewer_if_sanitized(48)),
                        1e-4)),
                    7);
            }
}

TEST(MediaAgreement, RaysTowardsLightsAreCountedAsSuch) {
    const auto rays = [](const char* integrator) {
        return render_text(through_the_box(integrator, 1, R"("string type" "homogeneous")", bright_sky))
            .stats.rays;
    };
    EXPECT_GT(rays(volpath).shadow, 32u);
    EXPECT_EQ(rays(R"(Integrator "simplevolpath")").shadow, 0u); // finds lights by chance
}

// A picture's dark part is left to the phase function, or it is not (MIS compensation). The same t-test.
TEST(MediaAgreement, PicturesOfTheSkyDrawnWholeOrInPart) {
    Image image = Image::rgb_image(16, 8);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 16; ++x)
            image.set_rgb(x, y, x < 4 && y < 3 ? Vec3(3, 2.5f, 2) : Vec3(.7f, .8f, .9f));
    const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "media_sky.pfm";
    write_image(file, image);
    const std::string medium =
        R"("string type" "homogeneous" "rgb sigma_a" [ .05 .1 .2 ] "rgb sigma_s" [ 1 .7 .4 ] "float g" .5)";
    auto means = [&](const char* integrator, int spp, bool compensate) {
        const std::string sky =
            fmt::format("LightSource \"infinite\" \"string filename\" \"{}\" \"bool compensate\" {}",
                        file.string(), compensate);
        return means_of_seeds(whole_box(integrator, spp, medium, sky), ColorMode::rgb);
    };
    const std::vector<double> expected =
        means(R"(Integrator "simplevolpath" "integer maxdepth" 12)", fewer_if_sanitized(256), true);
    for (bool compensate : {true, false})
        EXPECT_LT(std::abs(t_between(expected,
                                     means(R"(Integrator "volpath" "integer maxdepth" 12)",
                                           fewer_if_sanitized(64), compensate),
                                     1e-4)),
                  7)
            << compensate;
}

} // namespace
} // namespace alhazen::testing
