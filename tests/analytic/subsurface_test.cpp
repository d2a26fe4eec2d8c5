/// Light beneath surfaces, where the answer is an integral over the table of profiles.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/hash.h"
#include "materials/bssrdf.h"
#include "materials/fresnel.h"
#include "tests/support/render_scene.h"
#include "tests/support/statistics.h"

namespace alhazen::testing {
namespace {

constexpr int few_seeds = 8;
const char* const plane = R"(Shape "bilinearmesh" "point3 P" [ -90 -90 0  90 -90 0  -90 90 0  90 90 0 ])";
// Mean free paths of 1/10, and albedos of 0.9, 0.98, 0.999.
const char* const matter =
    R"(Material "subsurface" "rgb sigma_a" [ 1 .2 .01 ] "rgb sigma_s" [ 9 9.8 9.99 ] "float eta" 1.4)";
constexpr float eta = 1.4f;
const Vec3 albedos{0.9f, 0.98f, 0.999f};

// Light of one bounce seen along -z, from within one point.
std::string seen_from_above(const std::string& integrator, const std::string& scene, int spp,
                            const std::string& sampler = "independent") {
    return fmt::format(R"(
Integrator "{}" "integer maxdepth" 1
Sampler "{}" "integer pixelsamples" {}
PixelFilter "box"
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
LookAt 0 0 20  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [ -.0001 .0001 -.0001 .0001 ]
WorldBegin
{}
)",
                       integrator, sampler, spp, scene);
}

// Of three channels; in spectral mode of matter without colour, all three are alike.
std::array<std::vector<double>, 3> means_of(const std::string& text, ColorMode mode = ColorMode::rgb) {
    std::array<std::vector<double>, 3> means;
    for (int seed = 0; seed < few_seeds; ++seed) {
        RenderSettings settings;
        settings.seed = static_cast<std::uint64_t>(seed);
        settings.color = mode;
        const Image image = render_text(text, settings).image;
        for (std::size_t c = 0; c < 3; ++c) means[c].push_back(mean_of(image, static_cast<int>(c)));
    }
    return means;
}
// Seven standard errors of the mean of 8 seeds: a false-alarm rate below 3e-4 a comparison, seeds fixed. What
// probes leave out is the one thousandth part of own_error.
void expect_means(const std::array<std::vector<double>, 3>& means, Vec3 expected, double own_error) {
    for (std::size_t c = 0; c < 3; ++c) {
        const Moments m = moments(means[c]);
        const auto wanted = static_cast<double>(expected[static_cast<int>(c)]);
        EXPECT_NEAR(m.mean, wanted, 7 * std::sqrt(m.variance_of_mean) + own_error * wanted)
            << "channel " << c;
    }
}

// What a smooth border mirrors of a white sky, and what of the rest comes out again of it.
Vec3 under_white_sky(Vec3 comes_out) {
    const float mirrored = fresnel_dielectric(1, eta);
    return Vec3(mirrored) + comes_out * (1 - mirrored);
}
Vec3 effective(const DiffusionTable& table) {
    auto of = [&](float albedo) { return table.effective_albedo(table.row(albedo)); };
    return {of(albedos.x), of(albedos.y), of(albedos.z)};
}
const DiffusionTable& table() {
    static const DiffusionTable t(0, eta);
    return t;
}

TEST(Subsurface, HalfSpaceUnderAWhiteSkyHasTheEffectiveAlbedo) {
    for (const char* integrator : {"path", "volpath"})
        expect_means(
            means_of(seen_from_above(integrator, fmt::format("{}\n{}\n{}", white_sky, matter, plane), 64)),
            under_white_sky(effective(table())), 1.5e-3);
}

// Spectral mode, where one wavelength draws for all; with media somewhere, volpath's other walk.
TEST(Subsurface, HalfSpaceOfGreyMatterInSpectralMode) {
    const char* const grey =
        R"(Material "subsurface" "float sigma_a" .2 "float sigma_s" 9.8 "float eta" 1.4)";
    const char* const far_away = R"(
AttributeBegin
MakeNamedMedium "fog" "string type" "homogeneous"
MediumInterface "fog" ""
Material "interface"
Translate 5000 0 0
Shape "sphere"
AttributeEnd)";
    for (const char* media : {"", far_away}) {
        const auto means = means_of(
            seen_from_above("volpath", fmt::format("{}\n{}\n{}\n{}", white_sky, media, grey, plane), 64),
            ColorMode::spectral);
        // White is the sky's colour.
        expect_means(means, Vec3(under_white_sky(effective(table())).y), 3e-3);
    }
}

TEST(Subsurface, OtherThingsBeneathTheSurfaceAreNotMet) {
    const std::string buried = R"(AttributeBegin
Material "diffuse" "rgb reflectance" [ .5 .5 .5 ]
Translate 0 0 -.3
Shape "sphere" "float radius" .25
AttributeEnd)";
    expect_means(means_of(seen_from_above(
                     "path", fmt::format("{}\n{}\n{}\n{}", white_sky, buried, matter, plane), 64)),
                 under_white_sky(effective(table())), 1.5e-3);
}

// However dense the matter is: down to lengths that floats cannot tell from none.
TEST(Subsurface, DenseMatterKeepsItsAlbedo) {
    for (const char* scale : {"1e3", "1e5", "1e9", "1e25"}) {
        std::string scene =
            fmt::format("{}\nTranslate 3 2 0\n{} \"float scale\" {}\n{}", white_sky, matter, scale, plane);
        std::string text = seen_from_above("path", scene, 64);
        text.replace(text.find("LookAt 0 0 20  0 0 0"), 20, "LookAt 3 2 20  3 2 0");
        expect_means(means_of(text), under_white_sky(effective(table())), 3e-3);
    }
}

// Points of a sphere within the chord d of one point have the area pi d^2, as those of a disk. So of light
// that would come out of a half space within the sphere's diameter all does, and the rest is lost. Probes
// across the normal and those that meet two sides must find that.
TEST(Subsurface, SphereLosesWhatSpreadsBeyondItsDiameter) {
    const std::string sphere = fmt::format("{}\n{}\nShape \"sphere\" \"float radius\" .2", white_sky, matter);
    Vec3 comes_out;
    for (int c = 0; c < 3; ++c) {
        constexpr int n = 4000;
        const float end = 4; // the diameter, in mean free paths
        for (int i = 0; i < n; ++i) {
            const float x = (static_cast<float>(i) + 0.5f) / n;
            comes_out[c] += table().radial(table().row(albedos[c]), end * x * x) * 2 * x * end / n;
        }
    }
    expect_means(means_of(seen_from_above("path", sphere, 256)), under_white_sky(comes_out), 1.5e-3);
}

// A lamp straight above, a little beside the point. What comes out there, of all that goes in at points
// chosen evenly on a square around: light that arrives, times the border's transmission, times the profile.
TEST(Subsurface, LampAgreesWithBruteForce) {
    const Vec3 lamp{0.1f, 0.05f, 0.2f};
    const std::string scene =
        fmt::format("LightSource \"point\" \"rgb I\" [ 1 1 1 ] \"point3 from\" [ {} {} {} ]\n{}\n{}", lamp.x,
                    lamp.y, lamp.z, matter, plane);
    const auto found = means_of(seen_from_above("path", scene, 256));

    const Bssrdf bssrdf(table(), Spectrum(1, 0.2f, 0.01f, 0.4f), Spectrum(9, 9.8f, 9.99f, 9.6f),
                        Wavelengths::rgb());
    std::array<std::vector<double>, 3> brute;
    for (std::uint64_t seed = 0; seed < few_seeds; ++seed) {
        Rng rng(seed);
        Vec3 sum;
        constexpr int n = 100000;
        constexpr float half = 2;
        for (int i = 0; i < n; ++i) {
            const float x = rng.uniform();
            const Vec3 p{half * (2 * x - 1), half * (2 * rng.uniform() - 1), 0};
            const Vec3 w = normalize(lamp - p);
            const float irradiance =
                bssrdf.exit_bsdf.eval({0, 0, 1}, w, TransportMode::radiance).f[0] / length_squared(lamp - p);
            const Spectrum s = bssrdf.eval(length(p)) * irradiance;
            sum += Vec3(s[0], s[1], s[2]) * (sqr(2 * half) / n);
        }
        for (int c = 0; c < 3; ++c)
            brute[static_cast<std::size_t>(c)].push_back(
                static_cast<double>(sum[c] * (1 - fresnel_dielectric(1, eta))));
    }
    for (std::size_t c = 0; c < 3; ++c) EXPECT_LT(std::abs(t_between(found[c], brute[c], 1.5e-3)), 7) << c;
}

// In a furnace a white ball of any roughness may not shine brighter than the sky, whatever light does to and
// fro.
TEST(Subsurface, WhiteBallInAFurnaceIsNotBrighter) {
    for (const char* roughness : {"0", "0.3"}) {
        std::string text = seen_from_above(
            "volpath",
            fmt::format("{}\nMaterial \"subsurface\" \"float sigma_a\" 0 \"float sigma_s\" 500 \"float "
                        "roughness\" {}\nShape \"sphere\"",
                        white_sky, roughness),
            64);
        text.replace(text.find("\"integer maxdepth\" 1"), 20, "\"integer maxdepth\" 20");
        for (const auto& means : means_of(text)) {
            const Moments m = moments(means);
            EXPECT_LT(m.mean, 1 + 7 * std::sqrt(m.variance_of_mean));
            EXPECT_GT(m.mean, 0.9);
        }
    }
}

TEST(Subsurface, PicturesDependOnNoSchedule) {
    const std::string text = seen_from_above(
        "path", fmt::format("{}\n{}\nShape \"sphere\" \"float radius\" .2", white_sky, matter), 16, "zsobol");
    RenderSettings settings;
    settings.threads = 1;
    settings.paths_in_flight = 1;
    const Image one = render_text(text, settings).image;
    settings.threads = 3;
    settings.paths_in_flight = 64;
    const Image many = render_text(text, settings).image;
    for (int y = 0; y < one.height(); ++y)
        for (int x = 0; x < one.width(); ++x) ASSERT_EQ(one.rgb(x, y), many.rgb(x, y));
}

TEST(Subsurface, IntegratorsThatDoNotSeeItSaySo) {
    for (const char* integrator : {"path", "volpath", "simplepath", "bdpt", "whitted"}) {
        Messages messages;
        const std::string text =
            seen_from_above(integrator, fmt::format("{}\n{}\n{}", white_sky, matter, plane), 1);
        build_world(read_pbrt_string(text, ".", messages), {}, messages);
        const bool sees = std::string_view(integrator) == "path" || std::string_view(integrator) == "volpath";
        bool told = false;
        for (const Message& m : messages.list())
            told |= m.text.find("does not see light that spreads beneath surfaces") != std::string::npos;
        EXPECT_EQ(told, !sees) << integrator;
    }
}

} // namespace
} // namespace alhazen::testing
