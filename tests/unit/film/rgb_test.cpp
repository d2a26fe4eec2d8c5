#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "color/color_space.h"
#include "color/sensor.h"
#include "film/film.h"
#include "tests/support/family.h"

namespace alhazen {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing_support::messages_of;

std::unique_ptr<Film> make_film(std::vector<Parameter> parameters, float exposure_time = 1) {
    return testing_support::make_member(
        film_kinds(), "rgb", std::move(parameters),
        [&](BuildContext& context) { context.exposure_time = exposure_time; });
}
std::vector<Parameter> sized(int x, int y, std::vector<Parameter> more = {}) {
    more.push_back(make_integer("xresolution", x));
    more.push_back(make_integer("yresolution", y));
    return more;
}
Parameter crop(std::vector<float> v) {
    return make_array("cropwindow", ValueType::real, std::move(v));
}
Parameter bounds(std::vector<int> v) {
    return make_array("pixelbounds", ValueType::integer, std::move(v));
}

TEST(RgbFilm, Defaults) {
    auto film = make_film({});
    EXPECT_EQ(film->resolution(), Vec2i(1280, 720));
    EXPECT_EQ(film->pixels(), (Rect2i{{0, 0}, {1280, 720}}));
    EXPECT_NEAR(film->diagonal(), 0.035f, 1e-8f);
    EXPECT_EQ(film->filename(), "");
    EXPECT_TRUE(film->half_float());
    EXPECT_FALSE(film->linear_transfer());
    EXPECT_TRUE(make_film({make_string("transfer", "linear")})->linear_transfer());
}

TEST(RgbFilm, CropWindowsRoundUpAndSortTheirEnds) {
    EXPECT_EQ(make_film(sized(10, 20, {crop({0.25f, 0.75f, 0.5f, 1})}))->pixels(),
              (Rect2i{{3, 10}, {8, 20}}));
    EXPECT_EQ(make_film(sized(10, 20, {crop({0.75f, 0.25f, 2, -1})}))->pixels(), (Rect2i{{3, 0}, {8, 20}}));
    // Windows that touch share no pixel and leave none out.
    EXPECT_EQ(make_film(sized(7, 7, {crop({0, 0.3f, 0, 1})}))->pixels().hi.x,
              make_film(sized(7, 7, {crop({0.3f, 1, 0, 1})}))->pixels().lo.x);
}

TEST(RgbFilm, PixelBounds) {
    EXPECT_EQ(make_film(sized(10, 20, {bounds({2, 5, 3, 9})}))->pixels(), (Rect2i{{2, 3}, {5, 9}}));
    EXPECT_THAT(messages_of(film_kinds(), "rgb", sized(10, 20, {bounds({2, 50, 3, 9})})),
                ElementsAre(HasSubstr("cut")));
    EXPECT_THAT(messages_of(film_kinds(), "rgb", sized(10, 20, {bounds({2, 5, 3, 9}), crop({0, 1, 0, 1})})),
                ElementsAre(HasSubstr("no effect")));
}

TEST(RgbFilm, SizesFromTheCommandLine) {
    auto film = make_film(sized(10, 20, {crop({0.25f, 0.75f, 0.5f, 1})}));
    film->set_resolution({100, 40});
    EXPECT_EQ(film->resolution(), Vec2i(100, 40));
    EXPECT_EQ(film->pixels(), (Rect2i{{25, 20}, {75, 40}}));
    film->set_pixels({{10, -5}, {200, 7}});
    EXPECT_EQ(film->pixels(), (Rect2i{{10, 0}, {100, 7}}));
    film->set_pixels({{300, 300}, {400, 400}});
    EXPECT_EQ(film->pixels(), (Rect2i{{99, 39}, {100, 40}}));
}

TEST(RgbFilm, PixelsAreMeansPlusCovariancesWithTheWeights) {
    auto film = make_film(sized(4, 3, {bounds({1, 4, 1, 3})}));
    film->start(ColorMode::rgb);
    film->add({1, 1}, Spectrum(1, 2, 3, 2), Wavelengths::rgb(), 0.5f);
    film->add({1, 1}, Spectrum(4, 2, 0, 2), Wavelengths::rgb(), 1.5f);
    film->add({3, 2}, Spectrum(8, 8, 8, 8), Wavelengths::rgb(), -0.5f);
    Image image = film->image();
    ASSERT_EQ(image.size(), Vec2i(3, 2));
    EXPECT_NEAR(image.at(0, 0, 0), 13 / 4.0f, 1e-5f); // 5 / 2 + 3 / 4
    EXPECT_NEAR(image.at(0, 0, 1), 2, 1e-5f);
    EXPECT_NEAR(image.at(0, 0, 2), 3 / 4.0f, 1e-5f);
    EXPECT_NEAR(image.at(2, 1, 0), 8, 1e-4f); // the only sample, whatever its weight
    EXPECT_EQ(image.at(1, 1, 0), 0);          // none
    EXPECT_EQ(image.info.origin, Vec2i(1, 1));
    EXPECT_EQ(image.info.display_window, (Rect2i{{0, 0}, {4, 3}}));
    film->start(ColorMode::rgb);
    EXPECT_EQ(film->image().at(0, 0, 0), 0);
}

TEST(RgbFilm, ManySmallSamplesDoNotDrown) {
    auto film = make_film(sized(1, 1));
    film->start(ColorMode::rgb);
    film->add({0, 0}, Spectrum(1e6f), Wavelengths::rgb(), 1);
    for (int i = 0; i < 100000; ++i) film->add({0, 0}, Spectrum(0.01f), Wavelengths::rgb(), 1);
    EXPECT_NEAR(film->image().at(0, 0, 0), 1001000.0f / 100001, 1e-4f);
}

TEST(RgbFilm, MaxComponentKeepsTheHue) {
    auto film = make_film(sized(1, 1, {make_float("maxcomponentvalue", 2)}));
    film->start(ColorMode::rgb);
    film->add({0, 0}, Spectrum(8, 4, 2, 4), Wavelengths::rgb(), 1);
    Image image = film->image();
    EXPECT_NEAR(image.at(0, 0, 0), 2, 1e-5f);
    EXPECT_NEAR(image.at(0, 0, 1), 1, 1e-5f);
    EXPECT_NEAR(image.at(0, 0, 2), 0.5f, 1e-5f);
}

TEST(RgbFilm, ExposureScales) {
    auto film = make_film(sized(1, 1, {make_float("iso", 200)}), 0.25f);
    film->start(ColorMode::rgb);
    film->add({0, 0}, Spectrum(1), Wavelengths::rgb(), 1);
    EXPECT_NEAR(film->image().at(0, 0, 1), 0.5f, 1e-5f);
}

// The mean over the wavelengths of a flat spectrum L is X Y Z of the equal-energy white times L and the
// integral of y.
TEST(RgbFilm, SpectralSamplesGiveTheColour) {
    auto film = make_film(sized(1, 1));
    film->start(ColorMode::spectral);
    constexpr int n = 4096;
    for (int i = 0; i < n; ++i)
        film->add({0, 0}, Spectrum(1 / 106.856895f),
                  Wavelengths::sample_visible((static_cast<float>(i) + 0.5f) / n), 1);
    Image image = film->image();
    Vec3 expected = srgb_space().from_xyz({1, 1, 1});
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.at(0, 0, c), expected[c], 2e-3f);
}

TEST(RgbFilm, OutputInTheColourSpaceOfTheDirective) {
    Messages messages;
    BuildContext context{messages};
    Node node;
    node.type = "rgb";
    node.parameters = sized(1, 1);
    node.color_space = find_color_space("rec2020");
    auto film = film_kinds().make(node, context, "");
    film->start(ColorMode::rgb);
    film->add({0, 0}, Spectrum(1, 0, 0, 0.33f), Wavelengths::rgb(), 1);
    Image image = film->image();
    // sRGB's red in Rec. 2020 (ITU-R BT.2087, equation 3).
    EXPECT_NEAR(image.at(0, 0, 0), 0.6274f, 1e-3f);
    EXPECT_NEAR(image.at(0, 0, 1), 0.0691f, 1e-3f);
    EXPECT_NEAR(image.at(0, 0, 2), 0.0164f, 1e-3f);
}

TEST(RgbFilm, KnowsTheSensorsOfPbrtByName) {
    for (const char* name : sensor_names)
        EXPECT_THAT(messages_of(film_kinds(), "rgb", {make_string("sensor", name)}), testing::IsEmpty())
            << name;
}

// Radiance 1 at every wavelength, by a camera with half a second and ISO 50: a quarter of what
// CameraSensor.ConstantRadianceIsTheAreaOfTheCurves derives.
TEST(RgbFilm, CamerasSeeByTheirCurves) {
    auto film = make_film(sized(1, 1, {make_string("sensor", "nikon_d850"), make_float("iso", 50)}), 0.5f);
    film->start(ColorMode::spectral);
    for (int i = 0; i < 4096; ++i)
        film->add({0, 0}, Spectrum(1), Wavelengths::sample_visible((static_cast<float>(i) + 0.5f) / 4096), 1);
    Image image = film->image();
    EXPECT_NEAR(image.values()[0], 126.827f / 4, 0.02f);
    EXPECT_NEAR(image.values()[1], 101.366f / 4, 0.02f);
    EXPECT_NEAR(image.values()[2], 93.713f / 4, 0.02f);
}

TEST(RgbFilm, BadParametersAreErrors) {
    auto messages = [](std::vector<Parameter> p) { return messages_of(film_kinds(), "rgb", std::move(p)); };
    EXPECT_THAT(messages({make_integer("xresolution", 0)}), ElementsAre(HasSubstr("\"xresolution\" is 0")));
    EXPECT_THAT(messages({make_integer("yresolution", 1000000)}), ElementsAre(HasSubstr("\"yresolution\"")));
    EXPECT_THAT(messages(sized(65536, 65536)), testing::SizeIs(1));
    EXPECT_THAT(messages({crop({0, 1, 0})}), ElementsAre(HasSubstr("has 3 values, but must have 4")));
    EXPECT_THAT(messages({crop({0.5f, 0.5f, 0, 1})}), ElementsAre(HasSubstr("holds no pixels")));
    EXPECT_THAT(messages(sized(10, 10, {bounds({5, 2, 0, 9})})),
                testing::Contains(HasSubstr("holds no pixels")));
    EXPECT_THAT(messages({make_string("sensor", "nikon_d85")}),
                ElementsAre(HasSubstr("did you mean \"nikon_d850\"?")));
    EXPECT_THAT(messages({make_string("sensor", "nikon_d850"), make_float("whitebalance", 100)}),
                ElementsAre(HasSubstr("sees no colours")));
    EXPECT_THAT(messages({make_string("transfer", "gamma")}), ElementsAre(HasSubstr("known: srgb, linear")));
    EXPECT_THAT(messages({make_float("maxcomponentvalue", 0)}), testing::SizeIs(1));
}

} // namespace
} // namespace alhazen
