/// The header of a PLY file: which elements follow, and how each is laid out.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace alhazen {

enum class PlyType { i8, u8, i16, u16, i32, u32, f32, f64 };

constexpr std::size_t ply_size(PlyType type) {
    constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<int>(type)];
}
constexpr bool is_whole(PlyType type) {
    return type != PlyType::f32 && type != PlyType::f64;
}

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::f32;
    bool is_list = false;
    PlyType count_type = PlyType::u8; ///< of a list's length
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;

    /// -1 when there is none.
    int find(std::string_view property) const;
};

struct PlyHeader {
    enum class Encoding { ascii, little_endian, big_endian };
    Encoding encoding = Encoding::ascii;
    std::vector<PlyElement> elements;
    std::size_t size = 0; ///< bytes of the header
    std::size_t lines = 0;

    const PlyElement* find(std::string_view element) const;
};

/// Throws std::runtime_error with the line.
PlyHeader parse_ply_header(std::string_view bytes);

} // namespace alhazen
