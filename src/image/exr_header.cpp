/// EXR files begin with attributes: name, type, size, value. The walk here makes sure that every size lies
/// inside the file and that the picture's size is sensible, before the library reserves memory by what a
/// broken file says.
#include <stdexcept>

#include <fmt/format.h>

#include "image/formats.h"

namespace alhazen {

namespace {

struct Walker {
    std::string_view bytes;
    std::size_t at = 8; // past the magic number and the version

    [[noreturn]] static void truncated() {
        throw std::runtime_error("truncated EXR file: the header has no end");
    }

    std::string_view text() {
        std::size_t end = bytes.find('\0', at);
        if (end == std::string_view::npos) truncated();
        std::string_view word = bytes.substr(at, end - at);
        if (word.size() > 255) throw std::runtime_error("corrupt EXR header: a name longer than 255 bytes");
        at = end + 1;
        return word;
    }
    std::string_view value() {
        if (bytes.size() - at < 4) truncated();
        std::uint32_t size = little32(bytes, at);
        at += 4;
        if (size > bytes.size() - at) truncated();
        std::string_view content = bytes.substr(at, size);
        at += size;
        return content;
    }
};

void check_window(std::string_view name, std::string_view box, std::size_t channels) {
    if (box.size() != 16) throw std::runtime_error(fmt::format("corrupt EXR header: bad size of {}", name));
    auto coordinate = [&](std::size_t i) { return static_cast<std::int32_t>(little32(box, i)); };
    for (std::size_t i = 0; i < 16; i += 4)
        if (coordinate(i) < -(1 << 30) || coordinate(i) > (1 << 30))
            throw std::runtime_error(fmt::format("corrupt EXR header: {} out of range", name));
    check_image_size(coordinate(8) - coordinate(0) + 1LL, coordinate(12) - coordinate(4) + 1LL,
                     static_cast<long long>(channels));
}

void check_tiles(std::string_view tiles) {
    if (tiles.size() < 8) throw std::runtime_error("corrupt EXR header: bad size of tiles");
    check_image_size(little32(tiles, 0), little32(tiles, 4), 1);
}

/// Channels: name, then 16 bytes each; an empty name ends the list.
std::size_t count_channels(std::string_view list) {
    std::size_t count = 0;
    for (std::size_t at = 0; at < list.size() && list[at] != '\0'; ++count) {
        std::size_t end = list.find('\0', at);
        if (end == std::string_view::npos || list.size() - end < 17)
            throw std::runtime_error("corrupt EXR header: the channel list has no end");
        at = end + 17;
    }
    return count;
}

} // namespace

void check_exr_header(std::string_view bytes) {
    if (bytes.size() < 8) Walker::truncated();
    std::uint32_t version = little32(bytes, 4);
    constexpr std::uint32_t deep = 0x800;
    if ((version & 0xff) != 2)
        throw std::runtime_error(fmt::format("unsupported EXR version {}", version & 0xff));
    if (version & deep) throw std::runtime_error("deep EXR images are not supported");
    Walker walker{bytes};
    std::string_view window;
    std::size_t channels = 0;
    // Of a file with several parts the first is read.
    for (std::string_view name = walker.text(); !name.empty(); name = walker.text()) {
        walker.text();
        std::string_view value = walker.value();
        if (name == "dataWindow") window = value;
        if (name == "tiles") check_tiles(value);
        if (name == "channels") channels = count_channels(value);
    }
    if (window.data() == nullptr) throw std::runtime_error("corrupt EXR header: no data window");
    if (channels == 0) throw std::runtime_error("EXR file without channels");
    check_window("dataWindow", window, channels);
}

} // namespace alhazen
