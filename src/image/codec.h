/// Image files: EXR, PNG, JPEG, HDR, TGA, BMP and PFM. A file to be read is known by its first bytes, and by
/// its suffix where the format has no mark of its own (TGA); a file to be written by its suffix.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "image/image.h"

namespace alhazen {

struct ReadOptions {
    /// How integer files are to be decoded; float files (EXR, HDR, PFM) are always linear.
    Encoding encoding;
};

enum class FloatDepth { half, single };
enum class Transfer { srgb, linear };

struct WriteOptions {
    /// Channel type of EXR files; the other float formats know one only.
    FloatDepth depth = FloatDepth::half;
    /// 8-bit files: linear light is clamped to 0 ... 1, taken through the curve and rounded to the nearest of
    /// 256 levels (no dithering). Values that are not finite become 0. Alpha is never encoded.
    Transfer transfer = Transfer::srgb;
    /// 1 ... 100.
    int jpeg_quality = 95;
    /// Kept by EXR (string attributes) and PNG (text); the others have no place for it. Added to, and
    /// stronger than, the image's own info.metadata. "color_space" names the space that the values are in
    /// (color/color_space.h), sRGB where there is none: EXR also gets chromaticities by it; the other formats
    /// have no place for it, and their values are converted to sRGB.
    std::map<std::string, std::string> metadata;
};

/// Reads an image; the values are linear light. Channel names: Y; Y A; R G B; R G B A; or the EXR file's own,
/// with R G B A first in each layer. Throws std::runtime_error whose text says what is wrong without naming
/// the file: missing, a directory, not an image, truncated, too large.
Image read_image(const std::filesystem::path& path, const ReadOptions& options = {});
/// The same from the bytes of a file; suffix (".tga") helps where the bytes do not tell.
Image decode_image(std::string_view bytes, std::string_view suffix, const ReadOptions& options = {});

/// Writes an image whole or not at all (temporary name, then renamed). EXR keeps every channel; PFM and HDR
/// take the colour; PNG and TGA colour or grey, with alpha if there is a channel A; JPEG and BMP colour or
/// grey. Throws std::runtime_error for an unsupported suffix (with the list), an empty image, a folder that
/// cannot be written.
void write_image(const std::filesystem::path& path, const Image& image, const WriteOptions& options = {});
/// The bytes that write_image writes to a file of this suffix.
std::string encode_image(std::string_view suffix, const Image& image, const WriteOptions& options = {});

/// ".exr", ".png", ... in lower case, that can be read and written.
std::span<const std::string> image_suffixes();
/// Whether the path has one of image_suffixes(), whatever its case.
bool has_image_suffix(const std::filesystem::path& path);
/// Whether files of this suffix keep floats (values above 1).
bool is_float_suffix(std::string_view suffix);

} // namespace alhazen
