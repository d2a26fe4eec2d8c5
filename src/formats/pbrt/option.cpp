#include "formats/pbrt/option.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "formats/pbrt/tokenizer.h"

namespace alhazen {

namespace {

struct KnownOption {
    std::string_view name;
    ValueType type;
};

constexpr std::array known_options{KnownOption{"disablepixeljitter", ValueType::boolean},
                                   KnownOption{"disabletexturefiltering", ValueType::boolean},
                                   KnownOption{"disablewavelengthjitter", ValueType::boolean},
                                   KnownOption{"displacementedgescale", ValueType::real},
                                   KnownOption{"msereferenceimage", ValueType::string},
                                   KnownOption{"msereferenceout", ValueType::string},
                                   KnownOption{"rendercoordsys", ValueType::string},
                                   KnownOption{"seed", ValueType::integer},
                                   KnownOption{"forcediffuse", ValueType::boolean},
                                   KnownOption{"pixelstats", ValueType::boolean},
                                   KnownOption{"wavefront", ValueType::boolean}};

std::string_view wanted(ValueType type) {
    switch (type) {
    case ValueType::boolean:
        return "true or false";
    case ValueType::integer:
        return "an integer";
    case ValueType::real:
        return "a number";
    default:
        return "a string in quotes";
    }
}

// A value comes as a number (float), a bool or a string, whichever it looks like.
bool convert(Parameter& value, ValueType type) {
    if (value.type == type) return true;
    if (type == ValueType::integer && value.type == ValueType::real) {
        float number = std::get<std::vector<float>>(value.values).front();
        if (number != std::floor(number) || std::abs(number) > 16777216.0f) return false;
        value.values = std::vector<int>{static_cast<int>(number)};
    } else if (type == ValueType::boolean && value.type == ValueType::string) {
        const std::string& word = std::get<std::vector<std::string>>(value.values).front();
        if (word != "true" && word != "false") return false;
        value.values = std::vector<std::uint8_t>{static_cast<std::uint8_t>(word == "true")};
    } else {
        return false;
    }
    value.type = type;
    return true;
}

} // namespace

std::string normal_option_name(std::string_view name) {
    std::string normal;
    for (char c : name)
        if (c != '-' && c != '_') normal += static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c);
    return normal;
}

std::string check_option(const std::string& name, Parameter& value) {
    auto option = std::find_if(known_options.begin(), known_options.end(),
                               [&](const auto& o) { return o.name == name; });
    if (option == known_options.end()) {
        std::vector<std::string> known;
        for (const KnownOption& o : known_options) known.emplace_back(o.name);
        return fmt::format("unknown option \"{}\"{}", printable(name), did_you_mean(name, known));
    }
    if (!convert(value, option->type))
        return fmt::format("option \"{}\" takes {}", name, wanted(option->type));
    if (name == "rendercoordsys") {
        const std::string& word = std::get<std::vector<std::string>>(value.values).front();
        if (word != "camera" && word != "cameraworld" && word != "world")
            return fmt::format(
                "option \"rendercoordsys\" is \"{}\"; expected \"camera\", \"cameraworld\" or \"world\"",
                printable(word));
    }
    return "";
}

} // namespace alhazen
