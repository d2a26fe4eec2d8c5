#include "image/image.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "image/resample.h"
#include "image/statistics.h"
#include "tests/unit/image/test_images.h"

namespace alhazen {
namespace {

using testing::ElementsAre;

TEST(Encoding, ParsesPbrtsNames) {
    EXPECT_EQ(Encoding::parse("sRGB"), Encoding::srgb());
    EXPECT_EQ(Encoding::parse("linear"), Encoding::linear());
    EXPECT_EQ(Encoding::parse("gamma 2.2"), Encoding::power(2.2f));
    EXPECT_EQ(Encoding::parse("auto"), Encoding{});
    for (const char* bad :
         {"", "rgb", "gamma", "gamma ", "gamma x", "gamma 0", "gamma -1", "gamma inf", "gamma 2 2"})
        EXPECT_EQ(Encoding::parse(bad), std::nullopt) << bad;
}

TEST(Encoding, SrgbKnownValuesAndInverse) {
    // IEC 61966-2-1: 0.5 encoded is ((0.5 + 0.055) / 1.055)^2.4 = 0.21404114.
    EXPECT_NEAR(Encoding::srgb().decode(0.5f), 0.21404114f, 1e-7f);
    EXPECT_NEAR(Encoding::srgb().encode(0.18f), 0.46135613f, 1e-6f);
    for (const Encoding& e : {Encoding::srgb(), Encoding::linear(), Encoding::power(2.2f)})
        for (int i = 0; i <= 255; ++i) {
            float v = static_cast<float>(i) / 255;
            EXPECT_NEAR(e.encode(e.decode(v)), v, 1e-6f);
        }
}

TEST(Image, RefusesSizesAndSaysWhy) {
    EXPECT_ERROR((Image{0, 5, {"Y"}}), "image of 0 x 5 pixels; both sides must be at least 1");
    EXPECT_ERROR((Image{5, -1, {"Y"}}), "both sides must be at least 1");
    EXPECT_ERROR((Image{70000, 1, {"Y"}}), "image of 70000 x 1 pixels; sides may be at most 65536");
    EXPECT_ERROR((Image{65536, 65536, {"Y"}}), "at most 536870912 values are allowed");
    EXPECT_ERROR((Image{1, 1, {}}), "image without channels");
}

TEST(Image, ColorOfChannels) {
    Image rgba(1, 1, {"A", "B", "G", "R"});
    for (int c = 0; c < 4; ++c) rgba.at(0, 0, c) = static_cast<float>(c + 1);
    EXPECT_EQ(rgba.rgb(0, 0), Vec3(4, 3, 2));
    EXPECT_TRUE(rgba.has_rgb());
    rgba.set_rgb(0, 0, {7, 8, 9});
    EXPECT_THAT(std::vector<float>(rgba.values().begin(), rgba.values().end()), ElementsAre(1, 9, 8, 7));

    Image grey = Image::grey_image(1, 1);
    grey.set_rgb(0, 0, {1, 1, 1});
    EXPECT_NEAR(grey.at(0, 0), 1, 1e-6f);
    EXPECT_FALSE(grey.has_rgb());

    Image layer(1, 1, {"Z", "view.B", "view.G", "view.R"});
    layer.at(0, 0, 3) = 5;
    EXPECT_EQ(layer.rgb(0, 0), Vec3(5, 0, 0));
}

TEST(Image, CropKeepsWhereItLies) {
    Image image = gradient(8, 6);
    image.info.origin = {10, 20};
    Image part = image.crop({{2, 1}, {5, 4}});
    EXPECT_EQ(part.size(), Vec2i(3, 3));
    EXPECT_EQ(part.rgb(0, 0), image.rgb(2, 1));
    EXPECT_EQ(part.rgb(2, 2), image.rgb(4, 3));
    EXPECT_EQ(part.info.origin, Vec2i(12, 21));
    EXPECT_EQ(part.info.display_window, (Rect2i{{10, 20}, {18, 26}}));
    EXPECT_ERROR(image.crop({{0, 0}, {9, 1}}), "crop 0,0 to 9,1 is not inside the image of 8 x 6 pixels");
    EXPECT_ERROR(image.crop({{3, 3}, {3, 4}}), "is not inside the image");
}

TEST(Image, SelectsChannels) {
    Image image = gradient(4, 3);
    const std::vector<std::string> names{"B", "R"};
    Image picked = image.select(names);
    EXPECT_EQ(picked.channel_names(), names);
    EXPECT_EQ(picked.at(3, 2, 0), image.at(3, 2, 2));
    EXPECT_EQ(picked.at(3, 2, 1), image.at(3, 2, 0));
    const std::vector<std::string> missing{"depth.Z"};
    EXPECT_ERROR(image.select(missing), "no channel \"depth.Z\" in the image; it has R, G, B");
}

TEST(Statistics, MeansAndNonFinite) {
    Image image(2, 1, {"Y", "A"});
    image.at(0, 0, 0) = 1;
    image.at(1, 0, 0) = 4;
    image.at(1, 0, 1) = 1;
    EXPECT_THAT(channel_means(image), ElementsAre(2.5, 0.5));
    EXPECT_EQ(count_non_finite(image), 0u);
    image.at(0, 0, 1) = std::numeric_limits<float>::quiet_NaN();
    image.at(1, 0, 0) = -infinity;
    EXPECT_EQ(count_non_finite(image), 2u);
}

TEST(Resample, BoxWeighsByArea) {
    // Three pixels into two: the middle one is shared by halves.
    Image row = Image::grey_image(3, 1);
    row.at(0, 0) = 1;
    row.at(1, 0) = 4;
    row.at(2, 0) = 10;
    Image two = resample_box(row, 2, 1);
    EXPECT_NEAR(two.at(0, 0), (1 * 2 + 4) / 3.0, 1e-6);
    EXPECT_NEAR(two.at(1, 0), (4 + 10 * 2) / 3.0, 1e-6);
    // Enlarged by a whole factor: repeated.
    Image six = resample_box(row, 6, 2);
    EXPECT_EQ(six.at(1, 1), 1);
    EXPECT_EQ(six.at(2, 0), 4);
}

TEST(Resample, BoxKeepsTheMean) {
    Image image = noise(37, 23);
    for (Vec2i size : {Vec2i{10, 7}, Vec2i{1, 1}, Vec2i{36, 23}, Vec2i{50, 60}}) {
        auto expected = channel_means(image), got = channel_means(resample_box(image, size.x, size.y));
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(got[c], expected[c], 1e-6);
    }
}

TEST(Resample, BilinearKeepsLinearRamps) {
    Image ramp = Image::grey_image(5, 1);
    for (int x = 0; x < 5; ++x) ramp.at(x, 0) = static_cast<float>(x);
    Image wide = resample_bilinear(ramp, 20, 3);
    for (int x = 0; x < 20; ++x) EXPECT_NEAR(wide.at(x, 1), std::clamp((x + 0.5) / 4 - 0.5, 0.0, 4.0), 1e-6);
}

} // namespace
} // namespace alhazen
