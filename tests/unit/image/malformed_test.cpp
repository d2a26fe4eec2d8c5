/// Broken image files: each is refused with a message, or read; none crashes, hangs or takes memory by what
/// it claims.
#include <fstream>

#include <gtest/gtest.h>

#include "base/file.h"
#include "base/hash.h"
#include "image/codec.h"
#include "tests/unit/image/test_images.h"

namespace alhazen {
namespace {

using namespace std::string_literals;

class MalformedFiles : public TemporaryFolder {};

TEST_F(MalformedFiles, MissingDirectoryAndEmpty) {
    std::filesystem::create_directory(file("folder.png"));
    std::ofstream(file("empty.png")).close();
    EXPECT_ERROR(read_image(file("none.png")), "no such file");
    EXPECT_ERROR(read_image(file("folder.png")), "is a directory, not a file");
    EXPECT_ERROR(read_image(file("empty.png")), "empty file, not an image");
}

TEST(Malformed, NotAnImage) {
    EXPECT_ERROR(decode_image("Hello, this is text.", ".png"),
                 "not an image: does not begin like \".png\" or any other known format");
    EXPECT_ERROR(decode_image("Hello, this is text.", ".EXR"), "does not begin like \".exr\"");
    EXPECT_ERROR(decode_image("Hello, this is text.", ".txt"),
                 "unsupported image suffix \".txt\"; known: .exr .png");
    EXPECT_ERROR(decode_image("Hello, this is text.", ""),
                 "image file name without a suffix; known: .exr .png");
    for (const char* suffix : {".png", ".exr", ".jpg", ".hdr", ".pfm", ".bmp"})
        EXPECT_ERROR(decode_image(std::string(1000, '\0'), suffix), "not an image: does not begin like");
    EXPECT_ERROR(decode_image(std::string(1000, '\0'), ".tga"), "not an image: no TGA header");
    EXPECT_ERROR(decode_image("Hello, this is not an image at all.", ".tga"), "not an image: no TGA header");
}

TEST(Malformed, TruncatedAtEveryLength) {
    // JPEG without its comments still has the pixels' end mark, which is looked for.
    for (const std::string& suffix : image_suffixes()) {
        const std::string whole = encode_image(suffix, noise(11, 9));
        for (std::size_t length = 1; length < whole.size(); ++length) {
            SCOPED_TRACE(suffix + " of " + std::to_string(length) + " bytes");
            try {
                decode_image(whole.substr(0, length), suffix);
                ADD_FAILURE() << "was read";
            } catch (const std::runtime_error& error) {
                std::string_view text = error.what();
                // With less than its mark a file is of no format at all; a number cut short is a wrong
                // number.
                bool known = text.find("truncated") != text.npos || text.find("corrupt") != text.npos ||
                             (length < 9 && text.find("not an image") != text.npos);
                EXPECT_TRUE(known) << text;
            }
        }
    }
}

TEST(Malformed, TruncatedSaysSo) {
    struct Case {
        const char *suffix, *text;
    };
    for (Case c : {Case{".png", "truncated PNG file: the data end too early"},
                   Case{".jpg", "truncated JPEG file: the data end too early"},
                   Case{".tga", "truncated TGA file: the data end too early"},
                   Case{".bmp", "truncated BMP file: the data end too early"},
                   Case{".hdr", "truncated HDR file: the pixels end too early"},
                   Case{".pfm", "truncated PFM file: 1188 bytes of pixels expected, 1187 found"},
                   Case{".exr", "EXR file"}}) {
        std::string whole = encode_image(c.suffix, noise(11, 9));
        EXPECT_ERROR(decode_image(whole.substr(0, whole.size() - 1), c.suffix), c.text);
    }
    std::string exr = encode_image(".exr", noise(11, 9));
    EXPECT_ERROR(decode_image(exr.substr(0, 60), ".exr"), "truncated EXR file: the header has no end");
    EXPECT_ERROR(decode_image("#?RADIANCE\n", ".hdr"), "truncated HDR file: the header has no end");
}

/// The bytes with some of them replaced.
std::string with(std::string bytes, std::size_t at, const std::string& replacement) {
    return bytes.replace(at, replacement.size(), replacement);
}

TEST(Malformed, Png) {
    const std::string png = encode_image(".png", noise(11, 9));
    EXPECT_ERROR(decode_image(with(png, 16, "\0\0\0\0"s), ""),
                 "image of 0 x 9 pixels; both sides must be at least 1");
    EXPECT_ERROR(decode_image(with(png, 16, "\0\1\1\0"s), ""),
                 "image of 65792 x 9 pixels; sides may be at most 65536");
    EXPECT_ERROR(decode_image(with(png, 16, "\xff\xff\xff\xff"), ""), "sides may be at most 65536");
    EXPECT_ERROR(decode_image(with(png, 16, "\0\0\xff\xff\0\0\x20\0"s), ""), "truncated PNG file");
    EXPECT_ERROR(decode_image(with(png, 16, "\0\0\0\xff"s), ""), "corrupt PNG file (not enough pixels)");
    EXPECT_ERROR(decode_image(with(png, 24, "\7"), ""), "corrupt PNG file (1/2/4/8/16-bit only)");
    EXPECT_ERROR(decode_image(with(png, 12, "JHDR"), ""), "corrupt PNG file: the header chunk is missing");
    EXPECT_ERROR(decode_image(with(png, 8, "\xff"), ""), "truncated PNG file");
}

TEST(Malformed, Jpeg) {
    const std::string jpeg = encode_image(".jpg", noise(11, 9));
    std::size_t frame = jpeg.find("\xff\xc0");
    ASSERT_NE(frame, jpeg.npos);
    EXPECT_ERROR(decode_image(with(jpeg, frame + 5, "\0\0"s), ""), "image of 11 x 0 pixels");
    EXPECT_ERROR(decode_image(with(jpeg, frame + 5, "\x10\0\x7f\xff"s), ""), "truncated JPEG file");
    EXPECT_ERROR(decode_image(with(jpeg, frame, "x"), ""), "corrupt JPEG file: a marker expected");
    EXPECT_ERROR(decode_image("\xff\xd8\xff\xd9\0\0\0\0"s, ""), "corrupt JPEG file: no pixels");
    // A table of 257 symbols: one more than the decoder has room for. The first length's count is five bytes
    // on.
    std::size_t table = jpeg.find("\xff\xc4");
    ASSERT_NE(table, jpeg.npos);
    EXPECT_ERROR(decode_image(with(jpeg, table + 5, "\xff\2"), ""), "corrupt JPEG file: bad Huffman table");
    std::string late =
        jpeg.substr(0, jpeg.size() - 2) + "\xff\xc4\1\x14\0"s + std::string(15, '\0') + "\xff"s;
    EXPECT_ERROR(decode_image(late + std::string(300, '\0') + "\xff\xd9", ""), "bad Huffman table");
    std::string scans;
    for (int i = 0; i < 300; ++i) scans += "\xff\xda\0\2"s;
    EXPECT_ERROR(decode_image(jpeg.substr(0, jpeg.size() - 2) + scans + "\xff\xd9", ""),
                 "more than 256 scans");
}

TEST(Malformed, TgaAndBmp) {
    const std::string tga = encode_image(".tga", noise(11, 9));
    EXPECT_ERROR(decode_image(with(tga, 12, "\xff\x7f\0\x10"s), ".tga"), "truncated TGA file");
    EXPECT_ERROR(decode_image(with(tga, 12, "\0\0"s), ".tga"), "image of 0 x 9 pixels");
    EXPECT_ERROR(decode_image(with(tga, 16, "\1"), ".tga"), "not an image: no TGA header");
    const std::string bmp = encode_image(".bmp", noise(11, 9));
    EXPECT_ERROR(decode_image(with(bmp, 18, "\xff\xff\xff\x7f"), ""),
                 "image of 2147483647 x 9 pixels; sides may be");
    EXPECT_ERROR(decode_image(with(bmp, 22, "\0\0\0\x80"s), ""),
                 "image of 11 x 2147483648 pixels; sides may be");
    EXPECT_ERROR(decode_image(with(bmp, 18, "\0\0\0\0"s), ""), "image of 0 x 9 pixels");
    EXPECT_ERROR(decode_image(with(bmp, 10, "\xff\xff\xff\xff"), ""), "truncated BMP file");
    EXPECT_ERROR(decode_image(with(bmp, 28, "\3"), ""), "corrupt BMP file");
}

TEST(Malformed, Pfm) {
    EXPECT_ERROR(decode_image("PF\n70000 1\n-1\n", ""),
                 "image of 70000 x 1 pixels; sides may be at most 65536");
    EXPECT_ERROR(decode_image("PF\n65536 65536\n-1\n", ""), "at most 536870912 values are allowed");
    EXPECT_ERROR(decode_image("PF\n8000 8000\n-1\n", ""),
                 "truncated PFM file: 768000000 bytes of pixels expected, 0");
    EXPECT_ERROR(decode_image("PF\n0 3\n-1\n", ""), "image of 0 x 3 pixels");
    EXPECT_ERROR(decode_image("PF\n-2 3\n-1\n", ""), "image of -2 x 3 pixels");
    EXPECT_ERROR(decode_image("PF\nwide 3\n-1\n", ""), "corrupt PFM header: width expected, got \"wide\"");
    EXPECT_ERROR(decode_image("PF\n3 99999999999999999999\n-1\n", ""), "corrupt PFM header: height expected");
    EXPECT_ERROR(decode_image("PF\n3 3\n0\n", ""), "corrupt PFM header: scale must not be 0");
    EXPECT_ERROR(decode_image("PF\n3 3\nnan\n", ""), "corrupt PFM header: scale must not be 0");
}

TEST(Malformed, Hdr) {
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    EXPECT_ERROR(decode_image("#?RADIANCE\n\n-Y 1 +X 1\n1234", ""), "FORMAT=32-bit_rle_rgbe expected");
    EXPECT_ERROR(decode_image("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n", ""),
                 "unsupported HDR FORMAT=32-bit_rle_xyze");
    EXPECT_ERROR(decode_image(header + "+X 1 -Y 1\n1234", ""),
                 "unsupported HDR resolution line \"+X 1 -Y 1\"");
    EXPECT_ERROR(decode_image(header + "-Y x +X 1\n1234", ""),
                 "corrupt HDR resolution line: a number expected");
    EXPECT_ERROR(decode_image(header + "-Y 1\n1234", ""), "unsupported HDR resolution line");
    EXPECT_ERROR(decode_image(header + "-Y 99999 +X 1\n1234", ""), "sides may be at most 65536");
    EXPECT_ERROR(decode_image(header + "-Y 9999 +X 9999\n1234", ""), "truncated HDR file");
    EXPECT_ERROR(decode_image(header + "-Y 1 +X 9\n\2\2\0\7"s, ""),
                 "corrupt HDR scanline: its length is not the");
    EXPECT_ERROR(decode_image(header + "-Y 1 +X 9\n\2\2\0\x09\xff\1"s, ""), "corrupt HDR run length");
    EXPECT_ERROR(decode_image(header + "-Y 1 +X 2\n\1\2\3\4\1\1\1\xff"s, ""), "corrupt HDR run length");
}

TEST(Malformed, Exr) {
    const std::string exr = encode_image(".exr", noise(11, 9));
    auto value = [&](const std::string& name_and_type) {
        return exr.find(name_and_type) + name_and_type.size() + 4;
    };
    std::size_t window = value("dataWindow\0box2i\0"s), channels = value("channels\0chlist\0"s);
    EXPECT_ERROR(decode_image(with(exr, window + 8, "\xff\xff\xff\x3f"), ""),
                 "image of 1073741824 x 9 pixels");
    EXPECT_ERROR(decode_image(with(exr, window + 8, "\xff\xff\xff\x7f"), ""), "dataWindow out of range");
    EXPECT_ERROR(decode_image(with(exr, window + 8, "\xf0\xff\xff\xff"), ""), "image of -15 x 9 pixels");
    EXPECT_ERROR(decode_image(with(exr, window + 12, "\xff\xff\0\0"s), ""), "EXR file");
    EXPECT_ERROR(decode_image(with(exr, window - 4, "\xff\xff\xff\x7f"), ""), "truncated EXR file");
    EXPECT_ERROR(decode_image(with(exr, window - 20, "e"), ""), "corrupt EXR header: no data window");
    EXPECT_ERROR(decode_image(with(exr, channels, "\0"s), ""), "EXR file without channels");
    // Even sides, which subsampling needs; the first channel is "B", its x sampling after the name and 8
    // bytes.
    const std::string even = encode_image(".exr", noise(12, 10));
    EXPECT_ERROR(decode_image(with(even, channels + 10, "\2"), ""), "EXR channel \"B\" is subsampled");
    EXPECT_ERROR(decode_image(with(exr, 4, "\3"), ""), "unsupported EXR version 3");
    EXPECT_ERROR(decode_image(with(exr, 5, "\x08"), ""), "deep EXR images are not supported");
    EXPECT_ERROR(decode_image(with(exr, exr.size() - 40, std::string(40, '\x55')), ""), "corrupt EXR file: ");
}

TEST(Malformed, ChangedBytesAreReadOrRefused) {
    Rng rng(20201);
    for (const std::string& suffix : image_suffixes()) {
        const std::string whole = encode_image(suffix, noise(11, 9));
        for (int i = 0; i < 400; ++i) {
            std::string changed = whole;
            // Headers matter most: half of the changes are among the first 100 bytes.
            std::size_t range = i % 2 ? whole.size() : std::min<std::size_t>(100, whole.size());
            for (int k = 0; k < 1 + i % 4; ++k)
                changed[rng.below(static_cast<std::uint32_t>(range))] = static_cast<char>(rng.next());
            try {
                Image image = decode_image(changed, suffix);
                EXPECT_FALSE(image.empty());
            } catch (const std::runtime_error& error) {
                EXPECT_STRNE(error.what(), "");
            }
        }
    }
}

} // namespace
} // namespace alhazen
