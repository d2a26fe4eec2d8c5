/// How the numbers in an integer image file stand for linear light, and back: pbrt's "encoding".
#pragma once

#include <optional>
#include <string_view>

namespace alhazen {

/// A curve between file values and linear light, both 0 ... 1. Alpha is never encoded (PNG
/// specification, 12.2).
struct Encoding {
    /// automatic: 8- and 16-bit integer files are sRGB, float files are linear.
    enum class Kind { automatic, linear, srgb, gamma };
    Kind kind = Kind::automatic;
    /// linear = file value ^ gamma; used by Kind::gamma only, positive.
    float gamma = 1;

    static Encoding linear() { return {Kind::linear, 1}; }
    static Encoding srgb() { return {Kind::srgb, 1}; }
    static Encoding power(float gamma) { return {Kind::gamma, gamma}; }
    /// "auto", "sRGB" (any case), "linear" or "gamma 2.2"; nullopt for anything else, a gamma that is not
    /// positive and finite included.
    static std::optional<Encoding> parse(std::string_view text);

    /// Linear light of a file value. automatic decodes as linear: whoever reads a file resolves it first.
    float decode(float value) const;
    /// File value of linear light; negative light is encoded as 0 by srgb and gamma.
    float encode(float light) const;

    bool operator==(const Encoding&) const = default;
};

} // namespace alhazen
