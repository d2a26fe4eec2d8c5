#include "image/encoding.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <string>

#include "color/tone.h"

namespace alhazen {

std::optional<Encoding> Encoding::parse(std::string_view text) {
    std::string lower(text);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (lower == "auto") return Encoding{};
    if (lower == "srgb") return srgb();
    if (lower == "linear") return linear();
    constexpr std::string_view word = "gamma ";
    if (!lower.starts_with(word)) return std::nullopt;
    std::string_view number = std::string_view(lower).substr(word.size());
    number.remove_prefix(std::min(number.find_first_not_of(' '), number.size()));
    float exponent = 0;
    auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), exponent);
    if (error != std::errc{} || end != number.data() + number.size()) return std::nullopt;
    if (!(exponent > 0) || !std::isfinite(exponent)) return std::nullopt;
    return power(exponent);
}

float Encoding::decode(float value) const {
    switch (kind) {
    case Kind::srgb:
        return srgb_decode(value);
    case Kind::gamma:
        return std::pow(std::max(value, 0.0f), gamma);
    case Kind::linear:
    case Kind::automatic:
        break;
    }
    return value;
}

float Encoding::encode(float light) const {
    switch (kind) {
    case Kind::srgb:
        return srgb_encode(std::max(light, 0.0f));
    case Kind::gamma:
        return std::pow(std::max(light, 0.0f), 1 / gamma);
    case Kind::linear:
    case Kind::automatic:
        break;
    }
    return light;
}

} // namespace alhazen
