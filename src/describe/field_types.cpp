#include "describe/field_types.h"

#include <fmt/format.h>

namespace alhazen {

namespace {

// The single value of a parameter stored as E, or nullptr with an error added.
template <class E>
const E* single_value(const Parameter& p, std::string_view expected, BuildContext& context) {
    auto* values = std::get_if<std::vector<E>>(&p.values);
    if (!values) {
        report_wrong_type(p, expected, context);
        return nullptr;
    }
    if (values->size() != 1) {
        report_wrong_count(p, "one value", context);
        return nullptr;
    }
    return values->data();
}

} // namespace

void report_wrong_type(const Parameter& p, std::string_view expected, BuildContext& context) {
    context.messages.add_error(p.place, fmt::format("parameter \"{}\" is declared as {}, but must be {}",
                                                    p.name, type_name(p.type), expected));
}

void report_wrong_count(const Parameter& p, std::string_view expected, BuildContext& context) {
    context.messages.add_error(p.place, fmt::format("parameter \"{}\" has {} values, but must have {}",
                                                    p.name, p.count(), expected));
}

void report_unknown_choice(const Parameter& p, const std::string& value,
                           const std::vector<std::string>& choices, BuildContext& context) {
    context.messages.add_error(p.place, fmt::format("parameter \"{}\" is \"{}\", which is not known{}",
                                                    p.name, value, did_you_mean(value, choices)));
}

std::string number_text(double value) {
    return fmt::format("{:.6g}", value);
}
std::string quoted_text(std::string_view value) {
    return fmt::format("\"{}\"", value);
}

void FieldType<bool>::read(bool& out, const Parameter& p, BuildContext& context) {
    if (auto* v = single_value<std::uint8_t>(p, type_text(), context)) out = *v != 0;
}

void FieldType<int>::read(int& out, const Parameter& p, BuildContext& context) {
    if (auto* v = single_value<int>(p, type_text(), context)) out = *v;
}

void FieldType<float>::read(float& out, const Parameter& p, BuildContext& context) {
    if (p.type == ValueType::integer) {
        if (auto* v = single_value<int>(p, type_text(), context)) out = static_cast<float>(*v);
    } else if (p.type != ValueType::real) {
        report_wrong_type(p, type_text(), context);
    } else if (auto* v = single_value<float>(p, type_text(), context)) {
        out = *v;
    }
}

void FieldType<std::string>::read(std::string& out, const Parameter& p, BuildContext& context) {
    if (p.type != ValueType::string)
        report_wrong_type(p, type_text(), context);
    else if (auto* v = single_value<std::string>(p, type_text(), context))
        out = *v;
}

std::string FieldType<Vec2>::default_text(Vec2 v) {
    return fmt::format("[{:.6g} {:.6g}]", v.x, v.y);
}
void FieldType<Vec2>::read(Vec2& out, const Parameter& p, BuildContext& context) {
    if (auto* v = single_value<Vec2>(p, type_text(), context)) out = *v;
}

std::string FieldType<Vec3>::default_text(Vec3 v) {
    return fmt::format("[{:.6g} {:.6g} {:.6g}]", v.x, v.y, v.z);
}
void FieldType<Vec3>::read(Vec3& out, const Parameter& p, BuildContext& context) {
    if (p.type == ValueType::rgb) {
        const auto& v = std::get<std::vector<float>>(p.values);
        if (v.size() == 3)
            out = {v[0], v[1], v[2]};
        else
            report_wrong_count(p, "three values", context);
    } else if (auto* v = single_value<Vec3>(p, type_text(), context)) {
        out = *v;
    }
}

} // namespace alhazen
