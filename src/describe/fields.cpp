#include "describe/fields.h"

#include <cmath>

#include <fmt/format.h>

namespace alhazen {

std::string FieldDoc::range_text() const {
    constexpr double inf = std::numeric_limits<double>::infinity();
    if (lowest > -inf && highest < inf && lowest_is_excluded)
        return fmt::format("greater than {} and at most {}", lowest, highest);
    if (lowest > -inf && highest < inf) return fmt::format("{} to {}", lowest, highest);
    if (lowest > -inf) return fmt::format("{} {}", lowest_is_excluded ? "greater than" : "at least", lowest);
    if (highest < inf) return fmt::format("at most {}", highest);
    return "";
}

namespace {

// Limits are rounded as values are, so that a limit itself is within.
bool in_range(const FieldDoc& field, float v) {
    const auto lowest = static_cast<float>(field.lowest), highest = static_cast<float>(field.highest);
    return (field.lowest_is_excluded ? v > lowest : v >= lowest) && v <= highest;
}
bool in_range(const FieldDoc& field, int v) {
    return (field.lowest_is_excluded ? v > field.lowest : v >= field.lowest) && v <= field.highest;
}

// The first number that is not finite or out of range.
struct Culprit {
    std::string value;
    std::size_t index;
    bool is_finite;
};

std::optional<Culprit> find_culprit(const FieldDoc& field, const Parameter& p) {
    auto check = [&](auto v, std::size_t i) -> std::optional<Culprit> {
        if (!std::isfinite(v)) return Culprit{number_text(static_cast<double>(v)), i, false};
        if (field.has_range() && !in_range(field, v)) return Culprit{fmt::format("{}", v), i, true};
        return std::nullopt;
    };
    std::optional<Culprit> bad;
    auto scan = [&](const auto& values) {
        using E = typename std::decay_t<decltype(values)>::value_type;
        for (std::size_t i = 0; i < values.size() && !bad; ++i) {
            if constexpr (std::is_same_v<E, float> || std::is_same_v<E, int>) {
                bad = check(values[i], i);
            } else if constexpr (std::is_same_v<E, Vec2> || std::is_same_v<E, Vec3>) {
                for (int c = 0; c < (std::is_same_v<E, Vec2> ? 2 : 3) && !bad; ++c)
                    bad = check(values[i][c], i);
            }
        }
    };
    std::visit(scan, p.values);
    return bad;
}

} // namespace

bool check_range(const FieldDoc& field, const Parameter& p, BuildContext& context) {
    // The numbers of these two are wavelengths and temperatures, not values of the field.
    bool is_value = p.type != ValueType::spectrum && p.type != ValueType::blackbody;
    FieldDoc unbounded;
    auto bad = find_culprit(is_value ? field : unbounded, p);
    if (!bad) return true;
    std::string which = p.count() > 1 ? fmt::format(" (its {} value)", ordinal(bad->index + 1)) : "";
    context.messages.add_error(p.place,
                               fmt::format("parameter \"{}\" is {}{}; it must be {}", p.name, bad->value,
                                           which, bad->is_finite ? field.range_text() : "a finite number"));
    return false;
}

void report_unknown_parameter(const Parameter& p, std::string_view owner,
                              const std::vector<std::string>& known, BuildContext& context) {
    if (p.may_be_unused) return;
    context.messages.add_unsupported(
        p.place, fmt::format("unknown parameter \"{}\" of {}{}", p.name, owner, did_you_mean(p.name, known)),
        Remedy::ignore());
}

Substitution substitute_node(const Node& node, std::string_view type,
                             const std::function<bool(const Parameter&)>& can_read) {
    Substitution result;
    result.node.type = type;
    result.node.name = node.name;
    result.node.place = node.place;
    std::string prefix = std::string(type) + ".";
    for (Parameter p : node.parameters) {
        std::string given_name = p.name;
        if (p.name.starts_with(prefix)) p.name.erase(0, prefix.size());
        if (!result.node.find(p.name) && can_read(p))
            result.node.parameters.push_back(std::move(p));
        else if (!p.may_be_unused)
            result.dropped.push_back(std::move(given_name));
    }
    return result;
}

void report_unknown_kind(const Node& node, std::string_view family, const std::vector<std::string>& known,
                         const Substitution& substitution, BuildContext& context) {
    std::string without;
    for (const std::string& name : substitution.dropped)
        without += (without.empty() ? ", without " : ", ") + quoted_text(name);
    const std::string& type = substitution.node.type;
    context.messages.add_unsupported(
        node.place, fmt::format("unknown {} \"{}\"{}", family, node.type, did_you_mean(node.type, known)),
        type.empty() ? Remedy::leave_out() : Remedy::use(quoted_text(type), without));
}

void report_missing_parameter(const FieldDoc& field, std::string_view owner, const Node& node,
                              BuildContext& context) {
    context.messages.add_error(node.place, fmt::format("{} needs the parameter \"{} {}\": {}", owner,
                                                       field.type, field.name, field.meaning));
}

} // namespace alhazen
