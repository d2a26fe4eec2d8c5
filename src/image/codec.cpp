#include "image/codec.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "base/file.h"
#include "image/formats.h"
#include "image/image_colors.h"

namespace alhazen {

namespace {

enum class Format { exr, png, jpeg, hdr, tga, bmp, pfm };

const std::array<std::string, 8>& suffix_list() {
    static const std::array<std::string, 8> list{".exr", ".png", ".jpg", ".jpeg",
                                                 ".hdr", ".pfm", ".tga", ".bmp"};
    return list;
}

constexpr std::array<Format, 8> format_of_suffix{Format::exr, Format::png, Format::jpeg, Format::jpeg,
                                                 Format::hdr, Format::pfm, Format::tga,  Format::bmp};

std::string lower_case(std::string_view text) {
    std::string lower(text);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return lower;
}

std::optional<Format> format_by_suffix(std::string_view suffix) {
    const auto& list = suffix_list();
    auto found = std::find(list.begin(), list.end(), lower_case(suffix));
    if (found == list.end()) return std::nullopt;
    return format_of_suffix[static_cast<std::size_t>(found - list.begin())];
}

std::optional<Format> format_by_magic(std::string_view bytes) {
    using namespace std::string_view_literals;
    if (bytes.starts_with("\x76\x2f\x31\x01"sv)) return Format::exr;
    if (bytes.starts_with("\x89PNG\r\n\x1a\n"sv)) return Format::png;
    if (bytes.starts_with("\xff\xd8\xff"sv)) return Format::jpeg;
    if (bytes.starts_with("#?"sv)) return Format::hdr;
    if (bytes.starts_with("BM"sv)) return Format::bmp;
    bool pfm = bytes.size() > 2 && bytes[0] == 'P' && (bytes[1] == 'F' || bytes[1] == 'f');
    if (pfm && std::isspace(static_cast<unsigned char>(bytes[2]))) return Format::pfm;
    return std::nullopt;
}

[[noreturn]] void throw_unsupported(std::string_view suffix) {
    std::string what = suffix.empty() ? "image file name without a suffix"
                                      : fmt::format("unsupported image suffix \"{}\"", suffix);
    throw std::runtime_error(fmt::format("{}; known: {}", what, fmt::join(suffix_list(), " ")));
}

} // namespace

Image decode_image(std::string_view bytes, std::string_view suffix, const ReadOptions& options) {
    auto format = format_by_magic(bytes);
    if (!format) {
        auto expected = format_by_suffix(suffix);
        if (!expected) throw_unsupported(suffix);
        if (bytes.empty()) throw std::runtime_error("empty file, not an image");
        if (*expected != Format::tga)
            throw std::runtime_error(fmt::format(
                "not an image: does not begin like \"{}\" or any other known format", lower_case(suffix)));
        format = expected;
    }
    switch (*format) {
    case Format::exr:
        return decode_exr(bytes);
    case Format::hdr:
        return decode_hdr(bytes);
    case Format::pfm:
        return decode_pfm(bytes);
    case Format::png:
        return decode_integer(IntegerFormat::png, bytes, options.encoding);
    case Format::jpeg:
        return decode_integer(IntegerFormat::jpeg, bytes, options.encoding);
    case Format::tga:
        return decode_integer(IntegerFormat::tga, bytes, options.encoding);
    case Format::bmp:
        break;
    }
    return decode_integer(IntegerFormat::bmp, bytes, options.encoding);
}

Image read_image(const std::filesystem::path& path, const ReadOptions& options) {
    return decode_image(read_file(path), path.extension().string(), options);
}

const RgbColorSpace* color_space_of(const Image& image, const WriteOptions& options) {
    for (const auto* metadata : {&options.metadata, &image.info.metadata})
        if (auto found = metadata->find("color_space"); found != metadata->end())
            return find_color_space(found->second);
    return nullptr;
}

namespace {

/// To sRGB, and without the word that it was anything else.
std::string encode_converted(std::string_view suffix, Image image, const RgbColorSpace& from,
                             WriteOptions options) {
    image.info.metadata["color_space"] = from.name;
    options.metadata.erase("color_space");
    return encode_image(suffix, in_srgb(std::move(image)), options);
}

} // namespace

std::string encode_image(std::string_view suffix, const Image& image, const WriteOptions& options) {
    auto format = format_by_suffix(suffix);
    if (!format) throw_unsupported(suffix);
    if (image.empty()) throw std::runtime_error("cannot write an image without pixels");
    if (*format == Format::exr) return encode_exr(image, options);
    if (auto space = color_space_of(image, options); space && space != &srgb_space())
        return encode_converted(suffix, image, *space, options);
    switch (*format) {
    case Format::exr:
        break;
    case Format::hdr:
        return encode_hdr(image);
    case Format::pfm:
        return encode_pfm(image);
    case Format::png:
        return encode_integer(IntegerFormat::png, image, options);
    case Format::jpeg:
        return encode_integer(IntegerFormat::jpeg, image, options);
    case Format::tga:
        return encode_integer(IntegerFormat::tga, image, options);
    case Format::bmp:
        break;
    }
    return encode_integer(IntegerFormat::bmp, image, options);
}

void write_image(const std::filesystem::path& path, const Image& image, const WriteOptions& options) {
    std::string bytes = encode_image(path.extension().string(), image, options);
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) throw std::runtime_error("is a directory, not a file");
    std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    if (!std::filesystem::is_directory(folder, ignored))
        throw std::runtime_error(fmt::format("no such folder: {}", folder.string()));
    write_file(path, bytes);
}

std::span<const std::string> image_suffixes() {
    return suffix_list();
}

bool has_image_suffix(const std::filesystem::path& path) {
    return format_by_suffix(path.extension().string()).has_value();
}

bool is_float_suffix(std::string_view suffix) {
    auto format = format_by_suffix(suffix);
    return format == Format::exr || format == Format::hdr || format == Format::pfm;
}

} // namespace alhazen
