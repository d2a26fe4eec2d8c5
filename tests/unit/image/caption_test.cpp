#include "image/caption.h"

#include <gtest/gtest.h>

namespace alhazen {
namespace {

int inked(const Image& image, Rect2i r) {
    int n = 0;
    for (int y = r.lo.y; y < r.hi.y; ++y)
        for (int x = r.lo.x; x < r.hi.x; ++x) n += image.rgb(x, y) == Vec3(1, 0, 0);
    return n;
}

TEST(Caption, TextIsAsLargeAsItSays) {
    for (int scale : {1, 3}) {
        Image image = Image::rgb_image(300, 60);
        draw_text(image, {10, 8}, "whitted, 16 spp", scale, {1, 0, 0});
        Vec2i size = text_size("whitted, 16 spp", scale);
        int all = inked(image, {{0, 0}, image.size()});
        EXPECT_GT(all, 100 * scale * scale);
        EXPECT_EQ(inked(image, {{10, 8}, Vec2i{10, 8} + size}), all);
        // Nor is it much smaller.
        EXPECT_GT(inked(image, {{10 + size.x * 9 / 10, 8}, Vec2i{10, 8} + size}), 0);
    }
    EXPECT_EQ(text_size("ab", 2).x, 2 * text_size("ab", 1).x);
}

TEST(Caption, DifferentLettersLookDifferent) {
    auto drawn = [](std::string_view text) {
        Image image = Image::rgb_image(12, 12);
        draw_text(image, {0, 0}, text, 1, {1, 0, 0});
        return std::vector<float>(image.values().begin(), image.values().end());
    };
    EXPECT_NE(drawn("a"), drawn("b"));
    EXPECT_NE(drawn("O"), drawn("0"));
    // What is not ASCII has no letter of its own.
    EXPECT_EQ(drawn("\x01"), drawn("?"));
}

TEST(Caption, TextIsCutOffAtTheEdges) {
    Image image = Image::rgb_image(20, 8);
    draw_text(image, {-5, -3}, "a long line of text", 2, {1, 0, 0});
    draw_text(image, {15, 5}, "another", 2, {1, 0, 0});
    EXPECT_GT(inked(image, {{0, 0}, image.size()}), 0);
}

TEST(Caption, ASheetHoldsEveryPictureAndItsWords) {
    std::vector<Captioned> pictures;
    for (int i = 0; i < 3; ++i) {
        Image image = Image::rgb_image(40, 30 - 5 * i);
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x) image.set_rgb(x, y, Vec3(i == 0, i == 1, i == 2));
        pictures.push_back({image, {"name", "time"}});
    }
    Image sheet = captioned_sheet(pictures);
    int red = 0, green = 0, blue = 0, ink = 0;
    for (int y = 0; y < sheet.height(); ++y)
        for (int x = 0; x < sheet.width(); ++x) {
            Vec3 c = sheet.rgb(x, y);
            red += c == Vec3(1, 0, 0), green += c == Vec3(0, 1, 0), blue += c == Vec3(0, 0, 1);
            ink += max_component(c) < 0.1f;
        }
    EXPECT_EQ(red, 40 * 30);
    EXPECT_EQ(green, 40 * 25);
    EXPECT_EQ(blue, 40 * 20);
    EXPECT_GT(ink, 100);
}

} // namespace
} // namespace alhazen
