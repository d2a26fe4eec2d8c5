#include "color/tone.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "color/matrix3.h"

namespace alhazen {

namespace {

Vec3 clip(Vec3 v) {
    // Written so that NaN becomes 0.
    auto lane = [](float x) { return x > 0 ? std::min(x, 1.0f) : 0.0f; };
    return {lane(v.x), lane(v.y), lane(v.z)};
}

/// Hill 2015: a rational fit of the ACES reference rendering and sRGB output transforms.
Vec3 aces(Vec3 v) {
    static constexpr Matrix3 input{
        {{{0.59719, 0.35458, 0.04823}, {0.07600, 0.90834, 0.01566}, {0.02840, 0.13383, 0.83777}}}};
    static constexpr Matrix3 output{
        {{{1.60475, -0.53108, -0.07367}, {-0.10208, 1.10813, -0.00605}, {-0.00327, -0.07276, 1.07602}}}};
    // Beyond this the curve is flat; the squares must not overflow.
    constexpr float bright = 1e8f;
    auto curve = [](float x) {
        return (x * (x + 0.0245786f) - 0.000090537f) / (x * (0.983729f * x + 0.4329510f) + 0.238081f);
    };
    v = input * min(max(v, Vec3(0)), Vec3(bright));
    return clip(output * Vec3(curve(v.x), curve(v.y), curve(v.z)));
}

/// Sobotka's AgX, base look: log2 encoding of 16.5 stops in slightly desaturated primaries, an S curve
/// (Wrensch's polynomial, error below 4e-6 in the square), and the primaries undone.
Vec3 agx(Vec3 v) {
    static constexpr Matrix3 inset{{{{0.842479062253094, 0.0784335999999992, 0.0792237451477643},
                                     {0.0423282422610123, 0.878468636469772, 0.0791661274605434},
                                     {0.0423756549057051, 0.0784336, 0.879142973793104}}}};
    static constexpr Matrix3 outset{{{{1.19687900512017, -0.0980208811401368, -0.0990297440797205},
                                      {-0.0528968517574562, 1.15190312990417, -0.0989611768448433},
                                      {-0.0529716355144438, -0.0980434501171241, 1.15107367264116}}}};
    static constexpr float darkest = -12.47393f, brightest = 4.026069f;
    auto curve = [](float linear) {
        float x = (std::clamp(std::log2(std::max(linear, 1e-10f)), darkest, brightest) - darkest) /
                  (brightest - darkest);
        return (((((15.5f * x - 40.14f) * x + 31.96f) * x - 6.868f) * x + 0.4298f) * x + 0.1191f) * x -
               0.00232f;
    };
    v = inset * max(v, Vec3(0));
    v = clip(outset * Vec3(curve(v.x), curve(v.y), curve(v.z)));
    // The curve's result is meant for a display of exponent 2.2.
    auto display = [](float x) { return std::pow(x, 2.2f); };
    return {display(v.x), display(v.y), display(v.z)};
}

} // namespace

float srgb_encode(float linear) {
    float x = std::abs(linear);
    float encoded = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
    return std::copysign(encoded, linear);
}

float srgb_decode(float encoded) {
    float x = std::abs(encoded);
    float linear = x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
    return std::copysign(linear, encoded);
}

float srgb_decode_byte(std::uint8_t byte) {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> t{};
        for (std::size_t i = 0; i < t.size(); ++i) t[i] = srgb_decode(static_cast<float>(i) / 255);
        return t;
    }();
    return table[byte];
}

Vec3 tone_map(ToneCurve curve, Vec3 linear_srgb) {
    switch (curve) {
    case ToneCurve::none:
        return linear_srgb;
    case ToneCurve::srgb:
        return clip(linear_srgb);
    case ToneCurve::aces:
        return aces(linear_srgb);
    case ToneCurve::agx:
        return agx(linear_srgb);
    }
    return linear_srgb;
}

std::optional<ToneCurve> find_tone_curve(std::string_view name) {
    for (std::size_t i = 0; i < tone_curve_names().size(); ++i) {
        if (tone_curve_names()[i] == name) return static_cast<ToneCurve>(i);
    }
    return std::nullopt;
}

const std::vector<std::string>& tone_curve_names() {
    static const std::vector<std::string> names{"none", "srgb", "aces", "agx"};
    return names;
}

} // namespace alhazen
