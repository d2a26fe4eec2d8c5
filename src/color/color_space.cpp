#include "color/color_space.h"

#include <array>
#include <cctype>

namespace alhazen {

namespace {

RgbColorSpace make_space(std::string name, Vec2d red, Vec2d green, Vec2d blue, const char* illuminant) {
    RgbColorSpace space;
    space.name = std::move(name);
    space.red = red;
    space.green = green;
    space.blue = blue;
    space.illuminant = named_spectrum(illuminant);
    Vec3d white = cie_integrals(*space.illuminant);
    white = white / white.y;
    space.white = chromaticity(white);
    Matrix3 primaries = Matrix3::from_columns(xyz_from_chromaticity(red), xyz_from_chromaticity(green),
                                              xyz_from_chromaticity(blue));
    space.xyz_from_rgb = primaries * Matrix3::diagonal(primaries.inverse() * white);
    space.rgb_from_xyz = space.xyz_from_rgb.inverse();
    return space;
}

const std::array<RgbColorSpace, 4>& spaces() {
    static const std::array<RgbColorSpace, 4> list{
        // ITU-R BT.709-6; IEC 61966-2-1.
        make_space("srgb", {0.64, 0.33}, {0.3, 0.6}, {0.15, 0.06}, "stdillum-D65"),
        // SMPTE EG 432-1 with the white of displays.
        make_space("dci-p3", {0.68, 0.32}, {0.265, 0.690}, {0.15, 0.06}, "stdillum-D65"),
        // ITU-R BT.2020-2.
        make_space("rec2020", {0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, "stdillum-D65"),
        // SMPTE ST 2065-1:2012.
        make_space("aces2065-1", {0.7347, 0.2653}, {0, 1}, {0.0001, -0.077}, "illum-acesD60"),
    };
    return list;
}

/// Cone responses of the Bradford transform (Lam 1985).
constexpr Matrix3 bradford{
    {{{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}}};

} // namespace

const RgbColorSpace& srgb_space() {
    return spaces()[0];
}

const RgbColorSpace* find_color_space(std::string_view name) {
    std::string lower;
    for (char c : name) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    for (const RgbColorSpace& space : spaces()) {
        if (space.name == lower) return &space;
    }
    return nullptr;
}

const std::vector<std::string>& color_space_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list;
        for (const RgbColorSpace& space : spaces()) list.push_back(space.name);
        return list;
    }();
    return names;
}

Matrix3 convert_rgb(const RgbColorSpace& from, const RgbColorSpace& to) {
    // Not the product of a matrix and its rounded inverse.
    if (from.name == to.name) return {};
    return to.rgb_from_xyz * from.xyz_from_rgb;
}

Vec2d chromaticity(Vec3d xyz) {
    double sum = xyz.x + xyz.y + xyz.z;
    return sum == 0 ? Vec2d() : Vec2d(xyz.x / sum, xyz.y / sum);
}

Vec3d xyz_from_chromaticity(Vec2d xy, double y) {
    if (xy.y == 0) return {};
    return {xy.x * y / xy.y, y, (1 - xy.x - xy.y) * y / xy.y};
}

Matrix3 adapt_white(Vec2d source, Vec2d target) {
    Vec3d from = bradford * xyz_from_chromaticity(source), to = bradford * xyz_from_chromaticity(target);
    Matrix3 gain = Matrix3::diagonal({to.x / from.x, to.y / from.y, to.z / from.z});
    return bradford.inverse() * gain * bradford;
}

} // namespace alhazen
