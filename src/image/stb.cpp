/// The implementation of stb_image and stb_image_write (Sean Barrett), compiled here once and with no
/// warnings of theirs. What the room calls is declared in stb.h.
#include <cstdlib>

#pragma GCC diagnostic push
#if defined(__clang__)
#pragma GCC diagnostic ignored "-Weverything"
#else
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#endif
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_TGA
#define STBI_ONLY_BMP
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_MAX_DIMENSIONS 65536
// Memory starts as zeros: a JPEG scan may name a Huffman table that the file never defines, and then decodes
// by whatever is there. An empty table is harmless.
#define STBI_MALLOC(size) std::calloc(1, size)
#define STBI_REALLOC(pointer, size) std::realloc(pointer, size)
#define STBI_FREE(pointer) std::free(pointer)
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb_image.h>
#include <stb_image_write.h>
#pragma GCC diagnostic pop

#include <climits>

#include "image/stb.h"

namespace alhazen {

namespace {

int length(std::string_view bytes) {
    return static_cast<int>(std::min<std::size_t>(bytes.size(), INT_MAX));
}

const stbi_uc* data(std::string_view bytes) {
    return reinterpret_cast<const stbi_uc*>(bytes.data());
}

void append(void* context, void* more, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(more),
                                               static_cast<std::size_t>(size));
}

template <class T>
StbPixels<T> owned(T* pixels) {
    return {pixels, [](T* p) { stbi_image_free(p); }};
}

} // namespace

std::optional<StbInfo> stb_info(std::string_view bytes) {
    StbInfo info;
    if (!stbi_info_from_memory(data(bytes), length(bytes), &info.size.x, &info.size.y, &info.channels))
        return std::nullopt;
    info.bits = stbi_is_16_bit_from_memory(data(bytes), length(bytes)) ? 16 : 8;
    return info;
}

StbPixels<std::uint8_t> stb_load_8(std::string_view bytes, StbInfo& info) {
    return owned(
        stbi_load_from_memory(data(bytes), length(bytes), &info.size.x, &info.size.y, &info.channels, 0));
}

StbPixels<std::uint16_t> stb_load_16(std::string_view bytes, StbInfo& info) {
    return owned(
        stbi_load_16_from_memory(data(bytes), length(bytes), &info.size.x, &info.size.y, &info.channels, 0));
}

std::string stb_failure() {
    const char* reason = stbi_failure_reason();
    return reason ? reason : "unknown";
}

bool stb_write(IntegerFormat format, const StbInfo& info, const std::uint8_t* pixels, int jpeg_quality,
               std::string& out) {
    int w = info.size.x, h = info.size.y, n = info.channels;
    switch (format) {
    case IntegerFormat::png:
        return stbi_write_png_to_func(append, &out, w, h, n, pixels, w * n) != 0;
    case IntegerFormat::jpeg:
        return stbi_write_jpg_to_func(append, &out, w, h, n, pixels, jpeg_quality) != 0;
    case IntegerFormat::tga:
        return stbi_write_tga_to_func(append, &out, w, h, n, pixels) != 0;
    case IntegerFormat::bmp:
        break;
    }
    return stbi_write_bmp_to_func(append, &out, w, h, n, pixels) != 0;
}

} // namespace alhazen
