/// Private to the room: the few calls into stb, so that its macros and names stay in one file.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "image/formats.h"

namespace alhazen {

struct StbInfo {
    Vec2i size;
    int channels = 0;
    int bits = 8;
};

template <class T>
using StbPixels = std::unique_ptr<T, void (*)(T*)>;

/// Size and channels by the header; nullopt when stb does not take the bytes for an image.
std::optional<StbInfo> stb_info(std::string_view bytes);
/// Pixels, interleaved; null on failure, see stb_failure().
StbPixels<std::uint8_t> stb_load_8(std::string_view bytes, StbInfo& info);
StbPixels<std::uint16_t> stb_load_16(std::string_view bytes, StbInfo& info);
/// What the last failed call of this thread met with.
std::string stb_failure();
bool stb_write(IntegerFormat format, const StbInfo& info, const std::uint8_t* pixels, int jpeg_quality,
               std::string& out);

} // namespace alhazen
