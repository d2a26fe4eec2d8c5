/// How each C++ type of a member reads its value, prints its default, and names itself in the manual. A room
/// with types of its own (textures) specialises FieldType beside them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "describe/context.h"
#include "describe/value.h"

namespace alhazen {

/// static std::string type_text();
/// static std::string default_text(const M&);
/// static void read(M&, const Parameter&, BuildContext&);   adds an error when the parameter does not fit
template <class M>
struct FieldType;

/// Names of an enum's values 0, 1, 2 ... in order:
///     template <> struct EnumNames<Wrap> { static constexpr std::array names{"repeat", "black"}; };
template <class E>
struct EnumNames;

/// Adds "parameter "name" is a string, but must be a float" to the messages.
void report_wrong_type(const Parameter& parameter, std::string_view expected, BuildContext& context);
/// Adds "parameter "name" has 2 values, but must have one".
void report_wrong_count(const Parameter& parameter, std::string_view expected, BuildContext& context);
/// Adds "parameter "name" is "x", but must be one of ...".
void report_unknown_choice(const Parameter& parameter, const std::string& value,
                           const std::vector<std::string>& choices, BuildContext& context);

std::string number_text(double value);
std::string quoted_text(std::string_view value);

template <>
struct FieldType<bool> {
    static std::string type_text() { return "bool"; }
    static std::string default_text(bool v) { return v ? "true" : "false"; }
    static void read(bool& out, const Parameter& p, BuildContext& context);
};
template <>
struct FieldType<int> {
    static std::string type_text() { return "integer"; }
    static std::string default_text(int v) { return number_text(v); }
    static void read(int& out, const Parameter& p, BuildContext& context);
};
template <>
struct FieldType<float> {
    static std::string type_text() { return "float"; }
    static std::string default_text(float v) { return number_text(static_cast<double>(v)); }
    static void read(float& out, const Parameter& p, BuildContext& context);
};
template <>
struct FieldType<std::string> {
    static std::string type_text() { return "string"; }
    static std::string default_text(const std::string& v) { return quoted_text(v); }
    static void read(std::string& out, const Parameter& p, BuildContext& context);
};
/// point2 or vector2.
template <>
struct FieldType<Vec2> {
    static std::string type_text() { return "point2 | vector2"; }
    static std::string default_text(Vec2 v);
    static void read(Vec2& out, const Parameter& p, BuildContext& context);
};
/// point3, vector3, normal, or rgb read as three plain numbers.
template <>
struct FieldType<Vec3> {
    static std::string type_text() { return "point3 | vector3 | normal | rgb"; }
    static std::string default_text(Vec3 v);
    static void read(Vec3& out, const Parameter& p, BuildContext& context);
};

/// Arrays: of bool (as uint8_t), int, float, Vec2, Vec3, std::string. Copies; for large arrays the shape
/// moves the parameter's values out before reading (see take_values).
template <class E>
struct FieldType<std::vector<E>> {
    static std::string type_text() {
        if constexpr (std::is_same_v<E, int>) return "integer[]";
        if constexpr (std::is_same_v<E, float>) return "float[]";
        if constexpr (std::is_same_v<E, Vec2>) return "point2[] | vector2[]";
        if constexpr (std::is_same_v<E, Vec3>) return "point3[] | vector3[] | normal[]";
        if constexpr (std::is_same_v<E, std::string>) return "string[]";
        if constexpr (std::is_same_v<E, std::uint8_t>) return "bool[]";
    }
    static std::string default_text(const std::vector<E>& v) { return v.empty() ? "none" : "[...]"; }
    static void read(std::vector<E>& out, const Parameter& p, BuildContext& context) {
        bool is_name = p.type == ValueType::texture || p.type == ValueType::spectrum;
        if (auto* values = std::get_if<std::vector<E>>(&p.values); values && !is_name)
            out = *values;
        else
            report_wrong_type(p, type_text(), context);
    }
};

/// A member that may stay unset.
template <class E>
struct FieldType<std::optional<E>> {
    static std::string type_text() { return FieldType<E>::type_text(); }
    static std::string default_text(const std::optional<E>& v) {
        return v ? FieldType<E>::default_text(*v) : "none";
    }
    static void read(std::optional<E>& out, const Parameter& p, BuildContext& context) {
        E value{};
        FieldType<E>::read(value, p, context);
        out = std::move(value);
    }
};

/// Enums, by their names.
template <class E>
    requires std::is_enum_v<E>
struct FieldType<E> {
    static std::vector<std::string> choices() {
        return {EnumNames<E>::names.begin(), EnumNames<E>::names.end()};
    }
    static std::string type_text() {
        std::string text;
        for (const std::string& c : choices()) text += (text.empty() ? "" : " | ") + quoted_text(c);
        return text;
    }
    static std::string default_text(E v) { return quoted_text(choices()[static_cast<std::size_t>(v)]); }
    static void read(E& out, const Parameter& p, BuildContext& context) {
        std::string value;
        FieldType<std::string>::read(value, p, context);
        auto all = choices();
        if constexpr (requires { EnumNames<E>::other_names; })
            for (const auto& [other, name] : EnumNames<E>::other_names)
                if (value == other) value = name;
        for (std::size_t i = 0; i < all.size(); ++i)
            if (all[i] == value) {
                out = static_cast<E>(i);
                return;
            }
        if (p.type == ValueType::string && p.count() == 1) report_unknown_choice(p, value, all, context);
    }
};

} // namespace alhazen
