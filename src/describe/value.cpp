#include "describe/value.h"

namespace alhazen {

std::string_view type_name(ValueType type) {
    switch (type) {
    case ValueType::boolean:
        return "bool";
    case ValueType::integer:
        return "integer";
    case ValueType::real:
        return "float";
    case ValueType::point2:
        return "point2";
    case ValueType::vector2:
        return "vector2";
    case ValueType::point3:
        return "point3";
    case ValueType::vector3:
        return "vector3";
    case ValueType::normal:
        return "normal";
    case ValueType::rgb:
        return "rgb";
    case ValueType::blackbody:
        return "blackbody";
    case ValueType::spectrum:
        return "spectrum";
    case ValueType::string:
        return "string";
    case ValueType::texture:
        return "texture";
    }
    return "";
}

std::size_t Parameter::count() const {
    return std::visit([](const auto& v) { return v.size(); }, values);
}

Parameter make_bool(std::string name, bool value) {
    return make_array<std::uint8_t>(std::move(name), ValueType::boolean, {static_cast<std::uint8_t>(value)});
}
Parameter make_integer(std::string name, int value) {
    return make_array<int>(std::move(name), ValueType::integer, {value});
}
Parameter make_float(std::string name, float value) {
    return make_array<float>(std::move(name), ValueType::real, {value});
}
Parameter make_point3(std::string name, Vec3 value) {
    return make_array<Vec3>(std::move(name), ValueType::point3, {value});
}
Parameter make_rgb(std::string name, float r, float g, float b) {
    return make_array<float>(std::move(name), ValueType::rgb, {r, g, b});
}
Parameter make_string(std::string name, std::string value) {
    return make_array<std::string>(std::move(name), ValueType::string, {std::move(value)});
}
Parameter make_spectrum(std::string name, std::string spectrum_name) {
    return make_array<std::string>(std::move(name), ValueType::spectrum, {std::move(spectrum_name)});
}
Parameter make_texture(std::string name, std::string texture_name) {
    return make_array<std::string>(std::move(name), ValueType::texture, {std::move(texture_name)});
}

} // namespace alhazen
