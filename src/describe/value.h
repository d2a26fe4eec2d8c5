/// Parameters as a scene file gives them: a name, a type, values, and where they stand.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/messages.h"
#include "base/vec.h"

namespace alhazen {

/// What a parameter was declared as. `spectrum` holds a name or file name (strings) or wavelength-value pairs
/// (floats: nm, value, nm, value ...); `rgb` three floats; `blackbody` kelvins; `texture` the texture's name.
enum class ValueType {
    boolean,
    integer,
    real,
    point2,
    vector2,
    point3,
    vector3,
    normal,
    rgb,
    blackbody,
    spectrum,
    string,
    texture
};

/// The word pbrt uses for a type: "bool", "integer", "float", "point3", ...
std::string_view type_name(ValueType type);

/// Which alternative a type uses: boolean: uint8_t; integer: int; real, rgb, blackbody, spectrum samples:
/// float; point2, vector2: Vec2; point3, vector3, normal: Vec3; string, texture, spectrum by name:
/// std::string.
using Values = std::variant<std::vector<std::uint8_t>, std::vector<int>, std::vector<float>,
                            std::vector<Vec2>, std::vector<Vec3>, std::vector<std::string>>;

struct Parameter {
    std::string name;
    ValueType type = ValueType::real;
    Values values;
    Place place;
    /// Colour space of rgb values: "srgb", "dci-p3", "rec2020" or "aces2065-1".
    std::string color_space = "srgb";
    /// Given for a whole group of nodes (pbrt's Attribute), so that a node which has no such parameter
    /// ignores it.
    bool may_be_unused = false;

    std::size_t count() const;
};

/// Parameters in code, for examples, tests and scenes that are built rather than read.
Parameter make_bool(std::string name, bool value);
Parameter make_integer(std::string name, int value);
Parameter make_float(std::string name, float value);
Parameter make_point3(std::string name, Vec3 value);
Parameter make_rgb(std::string name, float r, float g, float b);
Parameter make_string(std::string name, std::string value);
/// A spectrum by name ("metal-Au-eta").
Parameter make_spectrum(std::string name, std::string spectrum_name);
Parameter make_texture(std::string name, std::string texture_name);
template <class T>
Parameter make_array(std::string name, ValueType type, std::vector<T> values) {
    Parameter p;
    p.name = std::move(name);
    p.type = type;
    p.values = std::move(values);
    return p;
}

} // namespace alhazen
