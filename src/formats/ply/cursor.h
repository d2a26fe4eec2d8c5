/// Where a PLY file's body is being read: one class for the words of ascii files, one for binary ones.
#pragma once

#include <algorithm>
#include <bit>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "formats/ply/header.h"

namespace alhazen {

/// What the message says was being read.
struct PlyProgress {
    std::string_view element;
    std::uint64_t number = 0;
};

class PlyAsciiCursor {
  public:
    static constexpr bool is_binary = false;

    PlyAsciiCursor(std::string_view bytes, const PlyHeader& header)
        : bytes_(bytes), start_(header.size), at_(header.size), header_lines_(header.lines) {}

    float real(PlyType type);
    std::int64_t whole(PlyType type);
    void skip(PlyType) { word(); }
    std::size_t left() const { return bytes_.size() - at_; }
    /// The least a value can take: a digit and a blank.
    static std::size_t least_size(PlyType) { return 2; }
    /// The text with the line.
    std::string located(const std::string& text) const;
    /// Throws std::runtime_error with the line.
    [[noreturn]] void fail(const std::string& text) const { throw std::runtime_error(located(text)); }

    PlyProgress progress;

  private:
    std::string_view word();

    std::string_view bytes_;
    std::size_t start_, at_, header_lines_;
};

/// swap: the file's byte order is not the machine's.
template <bool swap>
class PlyBinaryCursor {
  public:
    static constexpr bool is_binary = true;
    static constexpr bool is_swapped = swap;

    PlyBinaryCursor(std::string_view bytes, const PlyHeader& header) : bytes_(bytes), at_(header.size) {}

    float real(PlyType type) {
        switch (type) {
        case PlyType::f32:
            return load<float>();
        case PlyType::f64:
            return static_cast<float>(load<double>());
        default:
            return static_cast<float>(whole(type));
        }
    }
    std::int64_t whole(PlyType type) {
        switch (type) {
        case PlyType::i8:
            return load<std::int8_t>();
        case PlyType::u8:
            return load<std::uint8_t>();
        case PlyType::i16:
            return load<std::int16_t>();
        case PlyType::u16:
            return load<std::uint16_t>();
        case PlyType::i32:
            return load<std::int32_t>();
        case PlyType::u32:
            return load<std::uint32_t>();
        default:
            fail("expected a whole number");
        }
    }
    void skip(PlyType type) { skip(ply_size(type)); }
    void skip(std::size_t bytes) {
        need(bytes);
        at_ += bytes;
    }
    std::size_t left() const { return bytes_.size() - at_; }
    const char* here() const { return bytes_.data() + at_; }
    static std::size_t least_size(PlyType type) { return ply_size(type); }
    /// The text with the byte.
    std::string located(const std::string& text) const;
    /// Throws std::runtime_error with the byte.
    [[noreturn]] void fail(const std::string& text) const { throw std::runtime_error(located(text)); }

    PlyProgress progress;

  private:
    void need(std::size_t bytes) const;
    template <class T>
    T load() {
        need(sizeof(T));
        char raw[sizeof(T)];
        std::memcpy(raw, here(), sizeof(T));
        if constexpr (swap) std::reverse(raw, raw + sizeof(T));
        at_ += sizeof(T);
        T value;
        std::memcpy(&value, raw, sizeof(T));
        return value;
    }

    std::string_view bytes_;
    std::size_t at_;
};

} // namespace alhazen
