/// Private to the room: one pair of functions a file format, from bytes to an image and back. All throw
/// std::runtime_error saying what is wrong with the bytes.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "color/color_space.h"
#include "image/codec.h"

namespace alhazen {

/// The space that metadata "color_space" names; nullptr for none, or one that is not known.
const RgbColorSpace* color_space_of(const Image& image, const WriteOptions& options);

Image decode_exr(std::string_view bytes);
std::string encode_exr(const Image& image, const WriteOptions& options);

Image decode_pfm(std::string_view bytes);
std::string encode_pfm(const Image& image);

Image decode_hdr(std::string_view bytes);
std::string encode_hdr(const Image& image);

enum class IntegerFormat { png, jpeg, tga, bmp };
Image decode_integer(IntegerFormat format, std::string_view bytes, Encoding encoding);
std::string encode_integer(IntegerFormat format, const Image& image, const WriteOptions& options);

/// Throws when the file's header promises more than its bytes hold, or when a structure in it would cost far
/// more time or memory than the file's size justifies: stb takes missing bytes for zeros in some formats.
/// Returns the part of the bytes that was checked, the only part to decode.
std::string_view check_complete(IntegerFormat format, std::string_view bytes);

/// What EXR's header says, checked before the library allocates anything by it.
void check_exr_header(std::string_view bytes);

/// Text chunks of a PNG file (PNG specification, 11.3.4): uncompressed tEXt and iTXt.
std::map<std::string, std::string> png_text(std::string_view bytes);
/// The PNG file with text chunks put in after its header chunk. Throws when a name is not 1 ... 79 printable
/// ASCII characters.
std::string with_png_text(std::string bytes, const std::map<std::string, std::string>& text);

/// Unsigned integers in a file.
inline std::uint32_t byte_at(std::string_view bytes, std::size_t i) {
    return static_cast<unsigned char>(bytes[i]);
}
inline std::uint32_t little16(std::string_view bytes, std::size_t i) {
    return byte_at(bytes, i) | byte_at(bytes, i + 1) << 8;
}
inline std::uint32_t little32(std::string_view bytes, std::size_t i) {
    return little16(bytes, i) | little16(bytes, i + 2) << 16;
}
inline std::uint32_t big16(std::string_view bytes, std::size_t i) {
    return byte_at(bytes, i) << 8 | byte_at(bytes, i + 1);
}
inline std::uint32_t big32(std::string_view bytes, std::size_t i) {
    return big16(bytes, i) << 16 | big16(bytes, i + 2);
}

} // namespace alhazen
