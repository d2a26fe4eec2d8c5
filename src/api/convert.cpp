#include "api/convert.h"

#include <fmt/format.h>

namespace alhazen {

namespace {

Notice to_notice(const Message& message) {
    Notice notice;
    notice.is_error = message.kind == Message::Kind::error;
    if (message.place.file) notice.file = *message.place.file;
    notice.line = static_cast<int>(message.place.line);
    notice.column = static_cast<int>(message.place.column);
    notice.text = message.text;
    return notice;
}

ValueType to_value_type(SettingType type) {
    switch (type) {
    case SettingType::boolean:
        return ValueType::boolean;
    case SettingType::integer:
        return ValueType::integer;
    case SettingType::number:
        return ValueType::real;
    case SettingType::point2:
        return ValueType::point2;
    case SettingType::vector2:
        return ValueType::vector2;
    case SettingType::point3:
        return ValueType::point3;
    case SettingType::vector3:
        return ValueType::vector3;
    case SettingType::normal:
        return ValueType::normal;
    case SettingType::rgb:
        return ValueType::rgb;
    case SettingType::blackbody:
        return ValueType::blackbody;
    case SettingType::spectrum:
        return ValueType::spectrum;
    case SettingType::text:
        return ValueType::string;
    case SettingType::texture:
        return ValueType::texture;
    }
    return ValueType::real;
}

void check_multiple(std::size_t count, std::size_t of, const std::string& owner) {
    if (count % of != 0)
        throw make_input_error(owner,
                               fmt::format("{} numbers, but they must be a multiple of {}", count, of));
}

} // namespace

std::vector<Notice> to_notices(const std::vector<Message>& messages) {
    std::vector<Notice> notices;
    for (const Message& message : messages) notices.push_back(to_notice(message));
    return notices;
}

InputError to_input_error(const SceneError& error) {
    return InputError(to_notices(error.messages()), error.what());
}

InputError make_input_error(const std::string& owner, const std::string& text) {
    return to_input_error(SceneError(owner.empty() ? Place{} : Place::of_file(owner), text));
}

std::vector<Vec3> to_vec3s(const std::vector<float>& numbers, const std::string& owner) {
    check_multiple(numbers.size(), 3, owner);
    std::vector<Vec3> vectors;
    vectors.reserve(numbers.size() / 3);
    for (std::size_t i = 0; i < numbers.size(); i += 3)
        vectors.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
    return vectors;
}

std::vector<Vec2> to_vec2s(const std::vector<float>& numbers, const std::string& owner) {
    check_multiple(numbers.size(), 2, owner);
    std::vector<Vec2> vectors;
    vectors.reserve(numbers.size() / 2);
    for (std::size_t i = 0; i < numbers.size(); i += 2) vectors.emplace_back(numbers[i], numbers[i + 1]);
    return vectors;
}

Parameter to_parameter(Setting setting, const std::string& owner) {
    SettingValue& value = setting.value;
    std::string what = fmt::format("{}, setting \"{}\"", owner, setting.name);
    Parameter p;
    p.name = std::move(setting.name);
    p.type = to_value_type(value.type);
    p.place = Place::of_file(owner);
    switch (value.type) {
    case SettingType::boolean:
        p.values = std::vector<std::uint8_t>(value.integers.begin(), value.integers.end());
        break;
    case SettingType::integer:
        p.values = std::move(value.integers);
        break;
    case SettingType::point2:
    case SettingType::vector2:
        p.values = to_vec2s(value.numbers, what);
        break;
    case SettingType::point3:
    case SettingType::vector3:
    case SettingType::normal:
        p.values = to_vec3s(value.numbers, what);
        break;
    case SettingType::rgb:
        check_multiple(value.numbers.size(), 3, what);
        [[fallthrough]];
    case SettingType::number:
    case SettingType::blackbody:
        p.values = std::move(value.numbers);
        break;
    case SettingType::spectrum:
        if (value.words.empty()) {
            check_multiple(value.numbers.size(), 2, what);
            p.values = std::move(value.numbers);
            break;
        }
        [[fallthrough]];
    case SettingType::text:
    case SettingType::texture:
        p.values = std::move(value.words);
        break;
    }
    if (p.count() == 0) throw make_input_error(what, fmt::format("no values of type {}", type_name(p.type)));
    return p;
}

Node to_node(std::string kind, std::string name, Settings settings, const std::string& owner) {
    Node node;
    node.type = std::move(kind);
    node.name = std::move(name);
    node.place = Place::of_file(owner);
    for (Setting& setting : settings) node.set(to_parameter(std::move(setting), owner));
    return node;
}

Motion to_motion(const Pose& pose) {
    Matrix4 matrix;
    for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t column = 0; column < 4; ++column)
            matrix.m[row][column] = pose.matrix[4 * row + column];
    return {matrix, matrix};
}

} // namespace alhazen
