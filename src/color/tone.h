/// From linear light to what a display shows: transfer functions and tone curves.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/vec.h"

namespace alhazen {

/// sRGB transfer function (IEC 61966-2-1, the exact pieces), linear to encoded; negative values give -f(-x).
float srgb_encode(float linear);
/// Its inverse.
float srgb_decode(float encoded);
/// srgb_decode of byte / 255 from a table.
float srgb_decode_byte(std::uint8_t byte);

/// Luminance Y of linear sRGB (ITU-R BT.709 weights).
constexpr float luminance(Vec3 linear_srgb) {
    return dot(linear_srgb, Vec3(0.2126f, 0.7152f, 0.0722f));
}

enum class ToneCurve : std::uint8_t {
    none, ///< as it is
    srgb, ///< clipped to 0 ... 1
    aces, ///< filmic curve fitted to the ACES RRT and sRGB ODT by Stephen Hill (2015, MIT-licensed code
          ///< "ACES.hlsl")
    agx,  ///< AgX by Troy Sobotka (2022), base look, sixth-degree polynomial of Benjamin Wrensch (2023)
};
/// Linear sRGB scene light to linear sRGB display light; all but `none` give values in [0, 1]. Encode the
/// result with srgb_encode for 8-bit files. Exposure is applied by the caller, before.
Vec3 tone_map(ToneCurve curve, Vec3 linear_srgb);

std::optional<ToneCurve> find_tone_curve(std::string_view name);
const std::vector<std::string>& tone_curve_names();

} // namespace alhazen
