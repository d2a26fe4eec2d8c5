#include "image/terminal.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "image/codec.h"
#include "tests/unit/image/test_images.h"

namespace alhazen {
namespace {

/// Left half red, right half white.
Image flag() {
    return rgb_of(4, 4, [](int x, int, int c) { return x < 2 && c > 0 ? 0 : 1; });
}

std::string decoded_base64(const std::string& text) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    std::uint32_t bits = 0;
    int count = 0;
    for (char c : text) {
        if (c == '=') break;
        bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
        if ((count += 6) >= 8) out.push_back(static_cast<char>(bits >> (count -= 8) & 255));
    }
    return out;
}

TEST(HalfBlocks, TwoPixelsACell) {
    std::string red = "\x1b[38;2;255;0;0m\x1b[48;2;255;0;0m\u2580",
                white = "\x1b[38;2;255;255;255m\x1b[48;2;255;255;255m\u2580";
    std::string row = red + white + "\x1b[0m\n";
    EXPECT_EQ(draw_half_blocks(flag(), {2, {8, 16}}), row);
    // Square cells: half of a cell is twice as wide as high, so there are twice the rows.
    EXPECT_EQ(draw_half_blocks(flag(), {2, {8, 8}}), row + row);
    // An odd number of pixel rows: the last cell has no lower half.
    EXPECT_EQ(draw_half_blocks(flag(), {1, {8, 16}}).find("48;2"), std::string::npos);
}

TEST(HalfBlocks, NotFiniteIsBlack) {
    Image image = Image::rgb_image(1, 1);
    image.set_rgb(0, 0, {infinity, 0.5f, -1});
    EXPECT_EQ(draw_half_blocks(image, {1, {8, 16}}), "\x1b[38;2;0;188;0m\u2580\x1b[0m\n");
}

TEST(Kitty, HoldsAPngInChunks) {
    Image image = noise(100, 80);
    std::string text = draw_kitty(image, {50, {8, 16}});
    EXPECT_TRUE(text.starts_with("\x1b_Ga=T,f=100,c=50,m=1;"));
    std::string payload;
    std::size_t chunks = 0;
    for (std::size_t at = 0; (at = text.find("\x1b_G", at)) != text.npos; ++chunks) {
        std::size_t start = text.find(';', at) + 1, end = text.find("\x1b\\", start);
        ASSERT_NE(end, text.npos);
        EXPECT_LE(end - start, 4096u);
        EXPECT_EQ(text[start - 2], end + 3 == text.size() ? '0' : '1');
        payload += text.substr(start, end - start);
        at = end;
    }
    EXPECT_GT(chunks, 1u);
    Image read = decode_image(decoded_base64(payload), ".png");
    ASSERT_EQ(read.size(), image.size());
    EXPECT_NEAR(read.rgb(37, 21).y, image.rgb(37, 21).y, 0.01f);
}

TEST(Sixel, ColoursAndRuns) {
    std::string text = draw_sixel(flag(), {80, {8, 16}});
    EXPECT_TRUE(text.starts_with("\x1bPq\"1;1;4;4#0;2;0;0;0#1;2;0;0;20"));
    // Red is the cube's colour 5 * 42 = 210, white 251. Four pixels high: the low four bits, 15 above '?'.
    EXPECT_TRUE(text.ends_with("#210NN??$#251??NN$-\x1b\\\n")) << text.substr(text.size() - 30);
}

TEST(Sixel, BandsOfSixRows) {
    Image image = rgb_of(10, 13, [](int, int, int) { return 0; });
    std::string text = draw_sixel(image, {80, {8, 16}});
    EXPECT_TRUE(text.ends_with("#0!10~$-#0!10~$-#0!10@$-\x1b\\\n"));
    EXPECT_TRUE(draw_sixel(image, {1, {5, 10}}).starts_with("\x1bPq\"1;1;5;7"));
}

} // namespace
} // namespace alhazen
