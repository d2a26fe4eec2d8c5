/// PFM, the portable float map (Debevec): three lines of text ("PF" colour or "Pf" grey; width and height; a
/// scale whose sign says the byte order), then floats, bottom row first.
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include <fmt/format.h>

#include "image/formats.h"

namespace alhazen {

namespace {

/// The next word of the header, past white space; bytes starts behind it afterwards.
std::string_view next_word(std::string_view& bytes) {
    std::size_t start = std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size());
    std::size_t end = std::min(bytes.find_first_of(" \t\r\n", start), bytes.size());
    std::string_view word = bytes.substr(start, end - start);
    bytes.remove_prefix(end);
    return word;
}

template <class T>
T number(std::string_view& bytes, const char* what) {
    std::string_view word = next_word(bytes);
    T value{};
    auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size())
        throw std::runtime_error(
            fmt::format("corrupt PFM header: {} expected, got \"{}\"", what, word.substr(0, 20)));
    return value;
}

float float_at(std::string_view bytes, std::size_t i, bool big_endian) {
    return std::bit_cast<float>(big_endian ? big32(bytes, i) : little32(bytes, i));
}

} // namespace

Image decode_pfm(std::string_view bytes) {
    bool grey = next_word(bytes) == "Pf";
    auto width = number<long long>(bytes, "width");
    auto height = number<long long>(bytes, "height");
    auto scale = number<float>(bytes, "scale");
    if (!std::isfinite(scale) || scale == 0)
        throw std::runtime_error("corrupt PFM header: scale must not be 0");
    check_image_size(width, height, grey ? 1 : 3);
    Vec2i size{static_cast<int>(width), static_cast<int>(height)};
    std::size_t row = static_cast<std::size_t>(size.x) * (grey ? 1 : 3);
    std::size_t needed = 1 + row * static_cast<std::size_t>(size.y) * 4;
    if (bytes.size() < needed)
        throw std::runtime_error(fmt::format("truncated PFM file: {} bytes of pixels expected, {} found",
                                             needed - 1, bytes.empty() ? 0 : bytes.size() - 1));
    Image image = grey ? Image::grey_image(size.x, size.y) : Image::rgb_image(size.x, size.y);
    bool big_endian = scale > 0;
    float factor = std::abs(scale);
    std::size_t in = 1; // the one white space after the scale
    for (int y = size.y - 1; y >= 0; --y) {
        float* out = image.pixel(0, y).data();
        for (std::size_t i = 0; i < row; ++i, in += 4) {
            float v = float_at(bytes, in, big_endian);
            out[i] = factor == 1 ? v : v * factor;
        }
    }
    return image;
}

std::string encode_pfm(const Image& image) {
    bool grey = !image.has_rgb();
    std::string out = fmt::format("{}\n{} {}\n-1\n", grey ? "Pf" : "PF", image.width(), image.height());
    auto put = [&out](float v) {
        auto bits = std::bit_cast<std::uint32_t>(v);
        for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<char>(bits >> shift & 255));
    };
    for (int y = image.height() - 1; y >= 0; --y)
        for (int x = 0; x < image.width(); ++x) {
            Vec3 c = image.rgb(x, y);
            for (int i = 0; i < (grey ? 1 : 3); ++i) put(c[i]);
        }
    return out;
}

} // namespace alhazen
