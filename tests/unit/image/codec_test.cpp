#include "image/codec.h"

#include <bit>
#include <cmath>
#include <fstream>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/file.h"
#include "color/tone.h"
#include "tests/unit/image/test_images.h"

namespace alhazen {
namespace {

using testing::ElementsAre;

Image round_trip(std::string_view suffix, const Image& image, const WriteOptions& write = {},
                 const ReadOptions& read = {}) {
    return decode_image(encode_image(suffix, image, write), suffix, read);
}

/// The same channels and bits; NaN equals NaN.
void expect_identical(const Image& a, const Image& b) {
    ASSERT_EQ(a.size(), b.size());
    ASSERT_EQ(a.channel_names(), b.channel_names());
    for (std::size_t i = 0; i < a.values().size(); ++i)
        ASSERT_EQ(std::bit_cast<std::uint32_t>(a.values()[i]), std::bit_cast<std::uint32_t>(b.values()[i]))
            << i;
}

/// Every level of an 8-bit file, decoded.
Image all_levels(Encoding encoding, std::vector<std::string> channels) {
    Image image(16, 16, std::move(channels));
    for (int i = 0; i < 256; ++i)
        for (int c = 0; c < image.channels(); ++c) {
            int level = c == 1 ? 255 - i : c == 2 ? i * 7 % 256 : c == 3 ? i * 11 % 256 : i;
            float v = static_cast<float>(level) / 255;
            bool alpha = image.channel_names()[static_cast<std::size_t>(c)] == "A";
            image.at(i % 16, i / 16, c) = alpha ? v : encoding.decode(v);
        }
    return image;
}

class CodecFiles : public TemporaryFolder {};

TEST_F(CodecFiles, EverySuffixWritesAndReads) {
    Image image = gradient(12, 9);
    for (const std::string& suffix : image_suffixes()) {
        SCOPED_TRACE(suffix);
        auto path = file("picture" + suffix);
        write_image(path, image);
        Image read = read_image(path);
        ASSERT_EQ(read.size(), image.size());
        // JPEG loses most: hue at half the resolution.
        float tolerance = suffix == ".jpg" || suffix == ".jpeg" ? 0.1f : 0.01f;
        for (std::size_t i = 0; i < image.values().size(); ++i)
            EXPECT_NEAR(read.values()[i], image.values()[i], tolerance);
        EXPECT_TRUE(has_image_suffix(path));
    }
    EXPECT_FALSE(has_image_suffix("scene.pbrt"));
    EXPECT_TRUE(is_float_suffix(".EXR"));
    EXPECT_FALSE(is_float_suffix(".png"));
}

TEST_F(CodecFiles, SuffixInAnyCaseAndContentFirst) {
    write_image(file("A.PnG"), gradient(5, 4));
    EXPECT_EQ(read_image(file("A.PnG")).size(), Vec2i(5, 4));
    // A PNG that calls itself something else is still a PNG.
    std::filesystem::copy_file(file("A.PnG"), file("b.exr"));
    std::filesystem::copy_file(file("A.PnG"), file("texture"));
    EXPECT_EQ(read_image(file("b.exr")).info.bits, 8);
    EXPECT_EQ(read_image(file("texture")).info.bits, 8);
}

TEST_F(CodecFiles, NothingIsLeftWhenWritingFails) {
    EXPECT_ERROR(write_image(file("x.gif"), gradient(2, 2)),
                 "unsupported image suffix \".gif\"; known: .exr .png .jpg .jpeg .hdr .pfm .tga .bmp");
    EXPECT_ERROR(write_image(file("x"), gradient(2, 2)), "image file name without a suffix; known: .exr");
    EXPECT_ERROR(write_image(file("x.png"), Image{}), "cannot write an image without pixels");
    EXPECT_ERROR(write_image(file("none") / "x.png", gradient(2, 2)), "no such folder: ");
    std::filesystem::create_directory(file("folder.png"));
    EXPECT_ERROR(write_image(file("folder.png"), gradient(2, 2)), "is a directory, not a file");
    std::filesystem::remove(file("folder.png"));
    EXPECT_TRUE(std::filesystem::is_empty(file("x").parent_path()));
}

TEST(IntegerFiles, ByteExact) {
    for (const char* suffix : {".png", ".tga", ".bmp"})
        for (Transfer transfer : {Transfer::srgb, Transfer::linear}) {
            SCOPED_TRACE(suffix);
            Encoding e = transfer == Transfer::srgb ? Encoding::srgb() : Encoding::linear();
            Image image = all_levels(e, {"R", "G", "B"});
            Image read = round_trip(suffix, image, {.transfer = transfer, .metadata = {}}, {e});
            expect_identical(read, image);
            EXPECT_EQ(read.info.encoding, e);
        }
}

TEST(IntegerFiles, AlphaAndGreyByteExact) {
    for (const std::vector<std::string>& channels :
         {std::vector<std::string>{"R", "G", "B", "A"}, {"Y", "A"}, {"Y"}}) {
        Image image = all_levels(Encoding::srgb(), channels);
        expect_identical(round_trip(".png", image), image);
    }
    Image rgba = all_levels(Encoding::srgb(), {"R", "G", "B", "A"});
    expect_identical(round_trip(".tga", rgba), rgba);
}

TEST(IntegerFiles, RoundsToTheNearestLevelAndClamps) {
    Image image = Image::grey_image(7, 1);
    const float values[] = {0.4999f / 255, 0.5001f / 255, -3, 7, std::numeric_limits<float>::quiet_NaN(),
                            infinity,      -infinity};
    const float expected[] = {0, 1.0f / 255, 0, 1, 0, 1, 0};
    std::copy(std::begin(values), std::end(values), image.values().begin());
    Image read =
        round_trip(".png", image, {.transfer = Transfer::linear, .metadata = {}}, {Encoding::linear()});
    for (int x = 0; x < 7; ++x) EXPECT_EQ(read.at(x, 0), expected[x]) << x;
}

TEST(IntegerFiles, AutomaticIsSrgbAndGammaIsTaken) {
    Image half = Image::grey_image(1, 1);
    half.at(0, 0) = 128.0f / 255;
    std::string png = encode_image(".png", half, {.transfer = Transfer::linear, .metadata = {}});
    EXPECT_EQ(decode_image(png, "").at(0, 0), srgb_decode(128.0f / 255));
    EXPECT_EQ(decode_image(png, "", {Encoding::power(2)}).at(0, 0), std::pow(128.0f / 255, 2.0f));
    EXPECT_EQ(decode_image(png, "", {Encoding::linear()}).at(0, 0), 128.0f / 255);
}

TEST(IntegerFiles, JpegQuality) {
    Image image = noise(64, 64);
    EXPECT_LT(encode_image(".jpg", image, {.jpeg_quality = 20, .metadata = {}}).size(),
              encode_image(".jpg", image, {.jpeg_quality = 95, .metadata = {}}).size());
    EXPECT_ERROR(encode_image(".jpg", image, {.jpeg_quality = 0, .metadata = {}}),
                 "JPEG quality 0; 1 to 100");
}

TEST(IntegerFiles, SixteenBitPng) {
    // A grey 2 x 1 PNG with 16 bits: one stored deflate block (RFC 1951, 3.2.4) of a filter byte and two
    // numbers. The checksums are not looked at.
    auto chunk = [](const std::string& type, const std::string& data) {
        return std::string{0, 0, 0, static_cast<char>(data.size())} + type + data + std::string(4, '\0');
    };
    const std::string header{0, 0, 0, 2, 0, 0, 0, 1, 16, 0, 0, 0, 0};
    const std::string data{'\x78', '\x01', '\x01', 5,      0, '\xfa', '\xff', 0,
                           '\x12', '\x34', '\xff', '\xff', 0, 0,      0,      0};
    std::string png = "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) + chunk("IDAT", data) + chunk("IEND", "");
    Image image = decode_image(png, ".png", {Encoding::linear()});
    EXPECT_EQ(image.info.bits, 16);
    EXPECT_EQ(image.at(0, 0), 0x1234 / 65535.0f);
    EXPECT_EQ(image.at(1, 0), 1.0f);
    EXPECT_EQ(decode_image(png, ".png").at(0, 0), srgb_decode(0x1234 / 65535.0f));
}

TEST(Png, KeepsText) {
    Image image = gradient(3, 3);
    image.info.metadata = {{"Title", "old"}, {"Software", "Alhazen"}};
    WriteOptions options;
    options.metadata = {{"Title", "Spheres\nand a floor"},
                        {"Author", "Ibn al-Haytham, \xd8\xa7\xd8\xa8\xd9\x86"}};
    auto read = round_trip(".png", image, options).info.metadata;
    options.metadata["Software"] = "Alhazen";
    EXPECT_EQ(read, options.metadata);
    options.metadata = {{"", "x"}};
    EXPECT_ERROR(encode_image(".png", image, options),
                 "names of PNG text must be 1 to 79 printable ASCII characters");
}

TEST(Exr, FloatsAreKeptBitByBit) {
    Image image(7, 5, {"R", "G", "B", "A", "albedo.R", "albedo.G", "albedo.B", "Z"});
    for (std::size_t i = 0; i < image.values().size(); ++i)
        image.values()[i] = std::sqrt(static_cast<float>(i)) - 3;
    image.at(0, 0) = std::numeric_limits<float>::quiet_NaN();
    image.at(1, 0) = infinity;
    image.at(2, 0) = 1e38f;
    Image read = round_trip(".exr", image, {.depth = FloatDepth::single, .metadata = {}});
    ASSERT_THAT(read.channel_names(),
                ElementsAre("R", "G", "B", "A", "Z", "albedo.R", "albedo.G", "albedo.B"));
    EXPECT_EQ(read.info.bits, 32);
    expect_identical(read.select(image.channel_names()), image);
}

TEST(Exr, HalfRoundsAndStaysFinite) {
    Image image = Image::grey_image(4, 1);
    image.at(0, 0) = 0.1f;
    image.at(1, 0) = 1e6f;
    image.at(2, 0) = -infinity;
    image.at(3, 0) = std::numeric_limits<float>::quiet_NaN();
    Image read = round_trip(".exr", image);
    EXPECT_EQ(read.info.bits, 16);
    EXPECT_NEAR(read.at(0, 0), 0.1f, 0.1f / 2048);
    EXPECT_EQ(read.at(1, 0), 65504);
    EXPECT_EQ(read.at(2, 0), -infinity);
    EXPECT_TRUE(std::isnan(read.at(3, 0)));
}

TEST(Exr, WindowsAndMetadata) {
    Image image = gradient(20, 10).crop({{5, 2}, {9, 8}});
    image.info.metadata = {{"comments", "a \xc2\xb5 of light"}};
    WriteOptions options;
    options.metadata = {{"seed", "7"}};
    Image read = round_trip(".exr", image, options);
    EXPECT_EQ(read.info.origin, Vec2i(5, 2));
    EXPECT_EQ(read.info.display_window, (Rect2i{{0, 0}, {20, 10}}));
    EXPECT_EQ(read.info.metadata,
              (std::map<std::string, std::string>{{"comments", "a \xc2\xb5 of light"}, {"seed", "7"}}));
    EXPECT_EQ(read.rgb(0, 0).x, static_cast<float>(read.rgb(0, 5).x));
    options.metadata = {{"dataWindow", "x"}};
    EXPECT_ERROR(encode_image(".exr", image, options),
                 "cannot write EXR: EXR attribute \"dataWindow\" is reserved");
}

/// One pixel that is yellow-green in a space.
Image in_space(const char* name) {
    Image image = Image::rgb_image(1, 1);
    image.set_rgb(0, 0, {0.5f, 0.6f, 0.1f});
    image.info.metadata["color_space"] = name;
    return image;
}

TEST(Exr, ChromaticitiesOfTheColorSpace) {
    using namespace std::string_literals;
    const std::string mark = "chromaticities\0chromaticities\0\x20\0\0\0"s;
    std::string file = encode_image(".exr", in_space("rec2020"));
    std::size_t at = file.find(mark);
    ASSERT_NE(at, std::string::npos);
    // ITU-R BT.2020-2, table 3: red, green, blue, white.
    std::size_t i = at + mark.size();
    for (float expected : {0.708f, 0.292f, 0.170f, 0.797f, 0.131f, 0.046f, 0.3127f, 0.3290f}) {
        std::uint32_t bits = 0;
        for (int k = 3; k >= 0; --k)
            bits = bits << 8 | static_cast<unsigned char>(file[i + static_cast<std::size_t>(k)]);
        EXPECT_NEAR(std::bit_cast<float>(bits), expected, 1e-4f);
        i += 4;
    }
    EXPECT_EQ(decode_image(file, ".exr").info.metadata.at("color_space"), "rec2020");
    for (const char* name : {"srgb", "my own"})
        EXPECT_EQ(encode_image(".exr", in_space(name)).find(mark), std::string::npos);
}

TEST(Codec, FormatsWithoutColorSpaceHoldSrgb) {
    // 0.5, 0.6, 0.1 of Rec. 2020 in sRGB (ITU-R BT.2407, equation 1: the inverse of BT.2087's matrix).
    const Vec3 expected{0.470f, 0.617f, 0.043f};
    for (const char* suffix : {".png", ".pfm", ".bmp"}) {
        SCOPED_TRACE(suffix);
        Image read = round_trip(suffix, in_space("rec2020"));
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(read.rgb(0, 0)[c], expected[c], 5e-3f);
        EXPECT_EQ(read.info.metadata.count("color_space"), 0u);
        EXPECT_NEAR(round_trip(suffix, in_space("srgb")).rgb(0, 0).x, 0.5f, 5e-3f);
    }
    WriteOptions options;
    options.metadata["color_space"] = "rec2020";
    EXPECT_NEAR(round_trip(".pfm", in_space("srgb"), options).rgb(0, 0).x, expected.x, 5e-3f);
}

TEST(Pfm, FloatsAreKeptBitByBit) {
    Image image = noise(5, 4);
    image.at(0, 0) = std::numeric_limits<float>::quiet_NaN();
    image.at(1, 0) = -infinity;
    expect_identical(round_trip(".pfm", image), image);
    Image grey = Image::grey_image(2, 3);
    grey.at(1, 2) = 1e-40f;
    expect_identical(round_trip(".pfm", grey), grey);
}

TEST(Pfm, BothByteOrdersScaleAndRowsFromTheBottom) {
    // 1 is 3f800000, 2 is 40000000.
    using namespace std::string_literals;
    Image big = decode_image("Pf\n1 2\n1.0\n\x3f\x80\0\0\x40\0\0\0"s, "");
    EXPECT_EQ(big.at(0, 1), 1);
    EXPECT_EQ(big.at(0, 0), 2);
    Image little = decode_image("Pf 1 2 -3\n\0\0\x80\x3f\0\0\0\x40"s, "");
    EXPECT_EQ(little.at(0, 1), 3);
    EXPECT_EQ(little.at(0, 0), 6);
}

TEST(Hdr, RelativeErrorIsSmall) {
    // 8 bits of mantissa for the largest component: half a step of 1/128 at worst.
    for (int width : {3, 8, 300}) {
        Image image =
            rgb_of(width, 3, [](int x, int y, int c) { return std::exp2((x * 5 + y * 3 + c) % 60 - 30); });
        Image read = round_trip(".hdr", image);
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < width; ++x)
                EXPECT_LE(max_component(abs(read.rgb(x, y) - image.rgb(x, y))),
                          max_component(image.rgb(x, y)) / 256 * 1.001f);
    }
}

TEST(Hdr, EdgeValues) {
    Image image = Image::rgb_image(1, 6);
    image.set_rgb(0, 0, {infinity, 1, 0});
    image.set_rgb(0, 1, {std::numeric_limits<float>::quiet_NaN(), -1, 2});
    image.set_rgb(0, 2, {1e-44f, 0, 0});
    image.set_rgb(0, 3, {0.9999999f, 0.5f, 0}); // rounds up to the next power of two
    image.set_rgb(0, 4, {std::numeric_limits<float>::max(), 0, 0});
    image.set_rgb(0, 5, {255, 128, 1});
    Image read = round_trip(".hdr", image);
    EXPECT_EQ(read.rgb(0, 0), Vec3(0x1.fep126f, 0, 0));
    EXPECT_EQ(read.rgb(0, 1), Vec3(0, 0, 2));
    EXPECT_EQ(read.rgb(0, 2), Vec3(0.0f));
    EXPECT_EQ(read.rgb(0, 3), Vec3(1, 0.5f, 0));
    EXPECT_EQ(read.rgb(0, 4).x, 0x1.fep126f);
    EXPECT_EQ(read.rgb(0, 5), Vec3(255, 128, 1));
}

TEST(Hdr, OldRunsAndOrientation) {
    using namespace std::string_literals;
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    // One pixel of 1, then (1, 1, 1, 3): three more.
    Image run = decode_image(header + "-Y 1 +X 4\n\x80\x80\x80\x81\1\1\1\3"s, "");
    for (int x = 0; x < 4; ++x) EXPECT_EQ(run.rgb(x, 0), Vec3(1, 1, 1));
    Image turned = decode_image(header + "+Y 2 -X 1\n\x80\0\0\x81\0\x80\0\x81"s, "");
    EXPECT_EQ(turned.rgb(0, 1), Vec3(1, 0, 0));
    EXPECT_EQ(turned.rgb(0, 0), Vec3(0, 1, 0));
}

} // namespace
} // namespace alhazen
