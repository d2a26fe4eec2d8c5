/// RGB colour spaces: three primaries and a white.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/vec.h"
#include "color/matrix3.h"
#include "color/spectral.h"

namespace alhazen {

/// A linear RGB space. Primaries and white are CIE 1931 xy chromaticities; XYZ is scaled so that rgb (1, 1,
/// 1) has Y = 1 and the chromaticity of the illuminant.
struct RgbColorSpace {
    std::string name;
    Vec2d red, green, blue, white;
    const SpectralCurve* illuminant = nullptr; ///< y_integral is cie_y_integral; never null in a named space
    Matrix3 xyz_from_rgb, rgb_from_xyz;

    Vec3 to_xyz(Vec3 rgb) const { return xyz_from_rgb * rgb; }
    Vec3 from_xyz(Vec3 xyz) const { return rgb_from_xyz * xyz; }
};

/// The space of sRGB's primaries (ITU-R BT.709) and D65, in which RGB mode renders.
const RgbColorSpace& srgb_space();
/// "srgb", "dci-p3" (P3 with D65), "rec2020", "aces2065-1", in any case; nullptr for any other name.
const RgbColorSpace* find_color_space(std::string_view name);
const std::vector<std::string>& color_space_names();

/// Colours of `from` as colours of `to`, without adaptation to the other white.
Matrix3 convert_rgb(const RgbColorSpace& from, const RgbColorSpace& to);

/// CIE chromaticity of an XYZ colour; (0, 0) for black.
Vec2d chromaticity(Vec3d xyz);
/// The XYZ colour of a chromaticity and luminance.
Vec3d xyz_from_chromaticity(Vec2d xy, double y = 1);
/// XYZ to XYZ: colours seen under white `source` as they look under white `target` (von Kries scaling in
/// Bradford's cone responses; Lam 1985).
Matrix3 adapt_white(Vec2d source, Vec2d target);

} // namespace alhazen
