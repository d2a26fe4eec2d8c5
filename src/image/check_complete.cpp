/// Whether a PNG, JPEG, TGA or BMP file holds all that its header promises. The decoder takes what is missing
/// for zeros in some formats, and reserves memory by the header in all of them; so the structure is walked
/// first.
#include <cstdlib>
#include <stdexcept>

#include <fmt/format.h>

#include "image/formats.h"

namespace alhazen {

namespace {

void require(bool complete, const char* format) {
    if (!complete) throw std::runtime_error(fmt::format("truncated {} file: the data end too early", format));
}

/// Deflate packs at most 1032 bytes into one; what the header wants beyond that cannot be there.
void check_png(std::string_view bytes) {
    bool ended = false;
    std::size_t packed = 0, at = 8;
    while (!ended) {
        require(bytes.size() - at >= 12, "PNG");
        std::size_t size = big32(bytes, at);
        require(size <= bytes.size() - at - 12, "PNG");
        std::string_view type = bytes.substr(at + 4, 4);
        if (at == 8 && (type != "IHDR" || size != 13))
            throw std::runtime_error("corrupt PNG file: the header chunk is missing");
        ended = type == "IEND";
        if (type == "IDAT") packed += size;
        at += size + 12;
    }
    std::size_t width = big32(bytes, 16), height = big32(bytes, 20);
    check_image_size(static_cast<long long>(width), static_cast<long long>(height), 1);
    std::size_t bits_per_pixel = byte_at(bytes, 24);
    require(width * height / 8 * bits_per_pixel / 1032 <= packed, "PNG");
}

/// Huffman tables (ITU-T T.81, B.2.4.2): a byte with class and number, how many codes there are of each of 16
/// lengths, the symbols. The decoder has room for 256 symbols and does not count them; no real table has more
/// than 176.
void check_huffman_tables(std::string_view tables) {
    while (!tables.empty()) {
        std::size_t symbols = 0;
        for (std::size_t i = 1; i <= 16 && i < tables.size(); ++i) symbols += byte_at(tables, i);
        if (symbols > 255 || tables.size() < 17 + symbols)
            throw std::runtime_error("corrupt JPEG file: bad Huffman table");
        tables.remove_prefix(17 + symbols);
    }
}

/// The segment that starts with a marker at `at`: its bytes after the length.
std::string_view jpeg_segment(std::string_view bytes, std::size_t at) {
    require(bytes.size() - at >= 4, "JPEG");
    std::size_t size = big16(bytes, at + 2);
    if (size < 2) throw std::runtime_error("corrupt JPEG file: bad segment size");
    require(bytes.size() - at - 2 >= size, "JPEG");
    return bytes.substr(at + 4, size - 2);
}

/// Width times height as a frame header says.
std::size_t jpeg_pixels(std::string_view frame) {
    require(frame.size() >= 5, "JPEG");
    std::size_t height = big16(frame, 1), width = big16(frame, 3);
    check_image_size(static_cast<long long>(width), static_cast<long long>(height), 1);
    return width * height;
}

/// Walks the segments up to the first scan; sets pixels. Returns where the scan's data begin.
std::size_t walk_jpeg_header(std::string_view bytes, std::size_t& pixels) {
    for (std::size_t at = 2;;) {
        require(bytes.size() - at >= 4, "JPEG");
        if (byte_at(bytes, at) != 0xff) throw std::runtime_error("corrupt JPEG file: a marker expected");
        std::uint32_t marker = byte_at(bytes, at + 1);
        if (marker == 0xff) { // fill byte
            ++at;
            continue;
        }
        if (marker == 0xd9) throw std::runtime_error("corrupt JPEG file: no pixels");
        std::string_view segment = jpeg_segment(bytes, at);
        bool frame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
        if (frame) pixels = jpeg_pixels(segment);
        if (marker == 0xc4) check_huffman_tables(segment);
        at += segment.size() + 4;
        if (marker == 0xda) return at;
    }
}

/// A block of 8 x 8 pixels takes at least a bit of the file; scans beyond any sensible number only cost time.
/// Behind the first scan the decoder looks for markers in its own way, so every place there that could define
/// a table is held to be one (in coded pixels the two bytes cannot stand).
std::string_view check_jpeg(std::string_view bytes) {
    std::size_t pixels = 0;
    std::size_t first_scan = walk_jpeg_header(bytes, pixels);
    std::size_t end = bytes.find("\xff\xd9", first_scan);
    require(end != std::string_view::npos, "JPEG");
    bytes = bytes.substr(0, end + 2);
    require(pixels / 1024 <= bytes.size(), "JPEG");
    for (std::size_t at = first_scan; (at = bytes.find("\xff\xc4", at)) != std::string_view::npos; at += 2)
        check_huffman_tables(jpeg_segment(bytes, at));
    std::size_t scans = 1;
    for (std::size_t at = first_scan; (at = bytes.find("\xff\xda", at)) != std::string_view::npos; at += 2)
        ++scans;
    if (scans > 256) throw std::runtime_error("corrupt JPEG file: more than 256 scans");
    return bytes;
}

/// Run-length packets: a count and one pixel, or a count and as many pixels.
void check_tga_runs(std::string_view bytes, std::size_t at, std::size_t pixels, std::size_t pixel_bytes) {
    for (std::size_t done = 0; done < pixels;) {
        require(at < bytes.size(), "TGA");
        std::size_t count = (byte_at(bytes, at) & 127) + 1;
        bool run = byte_at(bytes, at) > 127;
        at += 1 + (run ? pixel_bytes : count * pixel_bytes);
        require(at <= bytes.size(), "TGA");
        done += count;
    }
}

void check_tga(std::string_view bytes) {
    require(bytes.size() >= 18, "TGA");
    std::uint32_t type = byte_at(bytes, 2), plain_type = type & 7, bits = byte_at(bytes, 16);
    bool known = (type & ~8u) == plain_type && plain_type >= 1 && plain_type <= 3 && byte_at(bytes, 1) <= 1;
    if (!known || bits < 8 || bits > 32) throw std::runtime_error("not an image: no TGA header");
    std::size_t width = little16(bytes, 12), height = little16(bytes, 14);
    check_image_size(static_cast<long long>(width), static_cast<long long>(height), 1);
    std::size_t pixel_bytes = (bits + 7) / 8, at = 18 + byte_at(bytes, 0);
    if (byte_at(bytes, 1) == 1) at += little16(bytes, 5) * std::size_t{(byte_at(bytes, 7) + 7) / 8};
    if (type & 8)
        check_tga_runs(bytes, at, width * height, pixel_bytes);
    else
        require(at + width * height * pixel_bytes <= bytes.size(), "TGA");
}

void check_bmp(std::string_view bytes) {
    require(bytes.size() >= 30, "BMP");
    std::size_t offset = little32(bytes, 10), header = little32(bytes, 14);
    bool old = header == 12; // OS/2 1.x: 16-bit sizes
    require(old || bytes.size() >= 34, "BMP");
    long long width = old ? little16(bytes, 18) : static_cast<std::int32_t>(little32(bytes, 18));
    long long height = old ? little16(bytes, 20) : static_cast<std::int32_t>(little32(bytes, 22));
    std::size_t bits = little16(bytes, old ? 24 : 28);
    height = std::abs(height); // negative: top row first
    check_image_size(width, height, 1);
    std::size_t row = (static_cast<std::size_t>(width) * bits + 31) / 32 * 4;
    require(offset <= bytes.size() && row * static_cast<std::size_t>(height) <= bytes.size() - offset, "BMP");
}

} // namespace

std::string_view check_complete(IntegerFormat format, std::string_view bytes) {
    switch (format) {
    case IntegerFormat::png:
        check_png(bytes);
        break;
    case IntegerFormat::jpeg:
        return check_jpeg(bytes);
    case IntegerFormat::tga:
        check_tga(bytes);
        break;
    case IntegerFormat::bmp:
        check_bmp(bytes);
        break;
    }
    return bytes;
}

} // namespace alhazen
