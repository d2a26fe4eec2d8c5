/// PNG, JPEG, TGA and BMP: integers from stb turned into linear floats, and linear floats into bytes.
#include <array>
#include <climits>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "base/threads.h"
#include "color/tone.h"
#include "image/formats.h"
#include "image/stb.h"

namespace alhazen {

namespace {

const char* name_of(IntegerFormat format) {
    switch (format) {
    case IntegerFormat::png:
        return "PNG";
    case IntegerFormat::jpeg:
        return "JPEG";
    case IntegerFormat::tga:
        return "TGA";
    case IntegerFormat::bmp:
        break;
    }
    return "BMP";
}

std::vector<std::string> names_of_channels(int count) {
    switch (count) {
    case 1:
        return {"Y"};
    case 2:
        return {"Y", "A"};
    case 3:
        return {"R", "G", "B"};
    default:
        return {"R", "G", "B", "A"};
    }
}

/// T is the file's integer type. Every value there is gets decoded once.
template <class T>
Image to_linear(const T* pixels, const StbInfo& info, Encoding encoding) {
    constexpr std::size_t levels = std::size_t{1} << (8 * sizeof(T));
    std::vector<float> linear(levels), curve(levels);
    for (std::size_t i = 0; i < levels; ++i) {
        linear[i] = static_cast<float>(i) / static_cast<float>(levels - 1);
        curve[i] = encoding.decode(linear[i]);
    }
    Image image(info.size.x, info.size.y, names_of_channels(info.channels));
    auto channels = static_cast<std::size_t>(info.channels);
    std::size_t alpha = channels % 2 == 0 ? channels - 1 : channels;
    auto values = image.values();
    parallel_ranges(values.size() / channels, 32768, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin * channels; i < end * channels; i += channels)
            for (std::size_t c = 0; c < channels; ++c)
                values[i + c] = c == alpha ? linear[pixels[i + c]] : curve[pixels[i + c]];
    });
    image.info.encoding = encoding;
    image.info.bits = static_cast<int>(8 * sizeof(T));
    return image;
}

std::uint8_t to_byte(float value, Transfer transfer) {
    if (std::isnan(value)) return 0;
    float v = std::clamp(value, 0.0f, 1.0f);
    if (transfer == Transfer::srgb) v = srgb_encode(v);
    return static_cast<std::uint8_t>(std::lround(v * 255));
}

/// Colour or grey, and alpha when the format keeps it.
std::vector<std::uint8_t> to_bytes(const Image& image, Transfer transfer, std::optional<int> alpha) {
    int colors = image.has_rgb() ? 3 : 1;
    std::vector<std::uint8_t> bytes;
    bytes.reserve(static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height()) *
                  static_cast<std::size_t>(colors + (alpha ? 1 : 0)));
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            Vec3 c = image.rgb(x, y);
            for (int i = 0; i < colors; ++i) bytes.push_back(to_byte(c[i], transfer));
            if (alpha) bytes.push_back(to_byte(image.at(x, y, *alpha), Transfer::linear));
        }
    return bytes;
}

} // namespace

Image decode_integer(IntegerFormat format, std::string_view bytes, Encoding encoding) {
    const char* name = name_of(format);
    if (bytes.size() > INT_MAX) throw std::runtime_error(fmt::format("{} file larger than 2 GB", name));
    bytes = check_complete(format, bytes);
    auto info = stb_info(bytes);
    if (!info) {
        // Asked for a size, stb does not say what is wrong; asked for pixels, it does.
        StbInfo unused;
        stb_load_8(bytes, unused);
        throw std::runtime_error(fmt::format("corrupt {} file ({})", name, stb_failure()));
    }
    check_image_size(info->size.x, info->size.y, info->channels);
    if (encoding.kind == Encoding::Kind::automatic) encoding = Encoding::srgb();
    Image image;
    if (info->bits == 16) {
        auto pixels = stb_load_16(bytes, *info);
        if (pixels) image = to_linear(pixels.get(), *info, encoding);
    } else {
        auto pixels = stb_load_8(bytes, *info);
        if (pixels) image = to_linear(pixels.get(), *info, encoding);
    }
    if (image.empty()) throw std::runtime_error(fmt::format("corrupt {} file ({})", name, stb_failure()));
    if (format == IntegerFormat::png) image.info.metadata = png_text(bytes);
    return image;
}

std::string encode_integer(IntegerFormat format, const Image& image, const WriteOptions& options) {
    bool keeps_alpha = format == IntegerFormat::png || format == IntegerFormat::tga;
    std::optional<int> alpha = keeps_alpha ? image.channel_index("A") : std::nullopt;
    // An image of alpha alone is grey.
    if (alpha == 0 && image.channels() == 1) alpha.reset();
    int channels = (image.has_rgb() ? 3 : 1) + (alpha ? 1 : 0);
    const char* name = name_of(format);
    // Beyond these sides the formats' 16-bit sizes, or the library's int arithmetic, end.
    auto total = static_cast<long long>(image.width()) * image.height() * 4;
    if ((format != IntegerFormat::png && std::max(image.width(), image.height()) > 65535) ||
        total > INT_MAX - 65536)
        throw std::runtime_error(fmt::format("an image of {} x {} pixels is too large for {}", image.width(),
                                             image.height(), name));
    if (options.jpeg_quality < 1 || options.jpeg_quality > 100)
        throw std::runtime_error(fmt::format("JPEG quality {}; 1 to 100 expected", options.jpeg_quality));
    std::vector<std::uint8_t> bytes = to_bytes(image, options.transfer, alpha);
    std::string out;
    if (!stb_write(format, {image.size(), channels, 8}, bytes.data(), options.jpeg_quality, out))
        throw std::runtime_error(fmt::format("cannot encode {}", name));
    if (format != IntegerFormat::png) return out;
    auto metadata = options.metadata;
    metadata.insert(image.info.metadata.begin(), image.info.metadata.end());
    return with_png_text(std::move(out), metadata);
}

} // namespace alhazen
