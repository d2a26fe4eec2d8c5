/// Text in PNG files (PNG specification, third edition, 11.3.3): a chunk is a length, a type of four letters,
/// the data and a checksum. ASCII text goes into tEXt, which every viewer shows, other UTF-8 into iTXt.
#include <algorithm>
#include <array>
#include <stdexcept>

#include <fmt/format.h>

#include "image/formats.h"

namespace alhazen {

namespace {

constexpr std::size_t signature_size = 8;
constexpr std::size_t header_end = signature_size + 12 + 13;

/// CRC-32 with the reflected polynomial 0xEDB88320 (PNG specification, annex D).
std::uint32_t checksum(std::string_view bytes) {
    std::uint32_t crc = ~0u;
    for (char c : bytes) {
        crc ^= static_cast<unsigned char>(c);
        for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? crc >> 1 ^ 0xEDB88320u : crc >> 1;
    }
    return ~crc;
}

void append_big32(std::string& out, std::uint32_t v) {
    for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<char>(v >> shift & 255));
}

bool is_ascii(std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return c == '\n' || (c >= ' ' && c <= '~'); });
}

std::string text_chunk(const std::string& name, const std::string& value) {
    if (name.empty() || name.size() > 79 || !is_ascii(name) || name.find('\n') != std::string::npos)
        throw std::runtime_error(fmt::format(
            "names of PNG text must be 1 to 79 printable ASCII characters, not \"{}\"", name.substr(0, 80)));
    std::string body;
    if (is_ascii(value))
        body = "tEXt" + name + '\0' + value;
    else // no compression, no language, no translated name
        body = "iTXt" + name + std::string(5, '\0') + value;
    std::string chunk;
    append_big32(chunk, static_cast<std::uint32_t>(body.size() - 4));
    chunk += body;
    append_big32(chunk, checksum(body));
    return chunk;
}

/// Name and value of one chunk; only uncompressed text.
void add_text(std::string_view type, std::string_view data, std::map<std::string, std::string>& text) {
    std::size_t end = data.find('\0');
    if (end == std::string_view::npos) return;
    std::string name(data.substr(0, end));
    std::string_view rest = data.substr(end + 1);
    if (type == "tEXt") {
        text[name] = rest;
    } else if (type == "iTXt" && rest.size() >= 2 && rest[0] == '\0') {
        rest.remove_prefix(2);
        for (int skipped = 0; skipped < 2; ++skipped) {
            std::size_t zero = rest.find('\0');
            if (zero == std::string_view::npos) return;
            rest.remove_prefix(zero + 1);
        }
        text[name] = rest;
    }
}

} // namespace

std::map<std::string, std::string> png_text(std::string_view bytes) {
    std::map<std::string, std::string> text;
    for (std::size_t at = signature_size; at + 12 <= bytes.size();) {
        std::size_t size = big32(bytes, at);
        if (size > bytes.size() - at - 12) break;
        add_text(bytes.substr(at + 4, 4), bytes.substr(at + 8, size), text);
        at += size + 12;
    }
    return text;
}

std::string with_png_text(std::string bytes, const std::map<std::string, std::string>& text) {
    std::string chunks;
    for (const auto& [name, value] : text) chunks += text_chunk(name, value);
    return bytes.insert(header_end, chunks);
}

} // namespace alhazen
