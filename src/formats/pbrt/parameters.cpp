#include "formats/pbrt/parameters.h"

#include <algorithm>
#include <array>
#include <cstring>

#include <fmt/format.h>

#include "formats/pbrt/version3.h"

namespace alhazen {

namespace {

using Kind = PbrtToken::Kind;

struct TypeWord {
    std::string_view word;
    ValueType type;
};

constexpr std::array type_words{
    TypeWord{"bool", ValueType::boolean},      TypeWord{"integer", ValueType::integer},
    TypeWord{"float", ValueType::real},        TypeWord{"point2", ValueType::point2},
    TypeWord{"vector2", ValueType::vector2},   TypeWord{"point3", ValueType::point3},
    TypeWord{"vector3", ValueType::vector3},   TypeWord{"normal", ValueType::normal},
    TypeWord{"rgb", ValueType::rgb},           TypeWord{"blackbody", ValueType::blackbody},
    TypeWord{"spectrum", ValueType::spectrum}, TypeWord{"string", ValueType::string},
    TypeWord{"texture", ValueType::texture}};

// A hopeless file must not make the search for duplicates slow.
constexpr std::size_t most_parameters = 1000;

struct Declaration {
    std::string type_word, name;
    ValueType type;
    Place place;
    std::string text() const { return fmt::format("\"{} {}\"", type_word, printable(name)); }
};

/// Takes the first word off the text; "" when there is none.
std::string_view take_word(std::string_view& text) {
    const std::size_t first = std::min(text.find_first_not_of(" \t"), text.size());
    const std::size_t last = std::min(text.find_first_of(" \t", first), text.size());
    const std::string_view word = text.substr(first, last - first);
    text.remove_prefix(last);
    return word;
}

ValueType find_type(std::string_view word, const Place& place, Messages& messages) {
    for (const TypeWord& known : type_words)
        if (known.word == word) return known.type;
    if (const OldName* old = find_old_name("parameter type", "", word)) {
        if (old->now.empty()) throw SyntaxError(place, describe_old_name(*old));
        messages.add_unsupported(place, describe_old_name(*old), remedy_for(*old));
        return find_type(old->now, place, messages);
    }
    std::vector<std::string> known;
    for (const TypeWord& w : type_words) known.emplace_back(w.word);
    throw SyntaxError(
        place, fmt::format("unknown parameter type \"{}\"{}", printable(word), did_you_mean(word, known)));
}

Declaration read_declaration(PbrtTokenizer& tokens, Messages& messages) {
    PbrtToken token = tokens.next();
    const std::string text = tokens.string(token);
    std::string_view rest = text;
    const std::string_view type_word = take_word(rest), name = take_word(rest);
    Place place = tokens.place(token);
    if (name.empty() || !take_word(rest).empty())
        throw SyntaxError(
            place, fmt::format("bad parameter declaration \"{}\"; expected \"type name\"", printable(text)));
    ValueType type = find_type(type_word, place, messages);
    return {std::string(type_word), std::string(name), type, std::move(place)};
}

std::string_view wanted(ValueType type) {
    switch (type) {
    case ValueType::boolean:
        return "true or false";
    case ValueType::integer:
        return "an integer";
    case ValueType::string:
        return "a string in quotes";
    case ValueType::texture:
        return "a texture's name in quotes";
    case ValueType::spectrum:
        return "a spectrum's name in quotes or numbers";
    default:
        return "a number";
    }
}

[[noreturn]] void throw_unexpected(PbrtTokenizer& tokens, const PbrtToken& token, const Declaration& d) {
    tokens.put_back(token); // it may be the directive to go on at
    throw SyntaxError(tokens.place(token), fmt::format("expected {} for {}, found {}", wanted(d.type),
                                                       d.text(), describe_token(token)));
}

/// Reads one value, or values in brackets: numbers by read_numbers, the rest by take(token).
template <class Take, class ReadNumbers, class One>
void read_values(PbrtTokenizer& tokens, const Declaration& d, Take take, ReadNumbers read_numbers, One one) {
    PbrtToken token = tokens.next();
    if (token.kind != Kind::open) {
        if (token.kind == Kind::end || token.kind == Kind::close) throw_unexpected(tokens, token, d);
        if (!one(token) && !take(token)) throw_unexpected(tokens, token, d);
        return;
    }
    Place open = tokens.place(token);
    for (;;) {
        read_numbers();
        token = tokens.next();
        if (token.kind == Kind::close) return;
        if (token.kind == Kind::end)
            throw SyntaxError(open,
                              fmt::format("the file ends inside the values of {}; expected \"]\"", d.text()));
        if (!take(token)) throw_unexpected(tokens, token, d);
    }
}

template <class T>
std::vector<T> read_number_values(PbrtTokenizer& tokens, const Declaration& d) {
    std::vector<T> values;
    read_values(
        tokens, d, [](const PbrtToken&) { return false; }, [&] { tokens.read_numbers(values); },
        [&](const PbrtToken& token) {
            if (token.kind != Kind::word || token.text[0] >= 'A') return false;
            values.push_back(tokens.number<T>(token));
            return true;
        });
    return values;
}

std::vector<std::string> read_string_values(PbrtTokenizer& tokens, const Declaration& d) {
    std::vector<std::string> values;
    auto take = [&](const PbrtToken& token) {
        if (token.kind != Kind::string) return false;
        values.push_back(tokens.string(token));
        return true;
    };
    read_values(
        tokens, d, take, [] {}, [](const PbrtToken&) { return false; });
    return values;
}

std::vector<std::uint8_t> read_bool_values(PbrtTokenizer& tokens, const Declaration& d) {
    std::vector<std::uint8_t> values;
    auto take = [&](const PbrtToken& token) {
        if (token.kind != Kind::string && token.kind != Kind::word) return false;
        if (token.text != "true" && token.text != "false") return false;
        values.push_back(token.text == "true");
        return true;
    };
    read_values(
        tokens, d, take, [] {}, [](const PbrtToken&) { return false; });
    return values;
}

template <class V>
std::vector<V> group(const std::vector<float>& numbers) {
    std::vector<V> grouped(numbers.size() / (sizeof(V) / sizeof(float)));
    if (!grouped.empty())
        std::memcpy(static_cast<void*>(grouped.data()), numbers.data(), grouped.size() * sizeof(V));
    return grouped;
}

/// What is wrong with n numbers for this type, or "".
std::string count_fault(const Declaration& d, const std::vector<float>& v, bool rgb_lists) {
    std::size_t n = v.size();
    switch (d.type) {
    case ValueType::point2:
    case ValueType::vector2:
        return n % 2 == 0 ? "" : fmt::format("{} has {} numbers; expected a multiple of 2", d.text(), n);
    case ValueType::point3:
    case ValueType::vector3:
    case ValueType::normal:
        return n % 3 == 0 ? "" : fmt::format("{} has {} numbers; expected a multiple of 3", d.text(), n);
    case ValueType::rgb:
        if (rgb_lists)
            return n % 3 == 0 && n > 0
                       ? ""
                       : fmt::format("{} has {} numbers; expected a multiple of 3", d.text(), n);
        return n == 3 ? ""
                      : fmt::format("{} has {} number{}; expected 3 in brackets", d.text(), n,
                                    n == 1 ? "" : "s");
    case ValueType::blackbody:
        return n == 1 ? ""
                      : fmt::format("{} has {} numbers; expected 1, the temperature in kelvins", d.text(), n);
    case ValueType::spectrum:
        if (n == 0 || n % 2 != 0)
            return fmt::format("{} has {} numbers; expected pairs of wavelength (nm) and value", d.text(), n);
        for (std::size_t i = 2; i < n; i += 2)
            if (!(v[i] > v[i - 2]))
                return fmt::format("{}: wavelength {} after {}; expected increasing wavelengths", d.text(),
                                   v[i], v[i - 2]);
        return "";
    default:
        return "";
    }
}

Values values_of(ValueType type, std::vector<float> numbers) {
    switch (type) {
    case ValueType::point2:
    case ValueType::vector2:
        return group<Vec2>(numbers);
    case ValueType::point3:
    case ValueType::vector3:
    case ValueType::normal:
        return group<Vec3>(numbers);
    default:
        return numbers;
    }
}

bool next_values_are_strings(PbrtTokenizer& tokens) {
    // A spectrum is told by its first value; the tokenizer can be copied to look that far ahead.
    PbrtTokenizer look = tokens;
    PbrtToken token = look.next();
    if (token.kind == Kind::open) token = look.next();
    return token.kind == Kind::string;
}

/// Sets the parameter's values; false with an error added when their number is wrong.
bool read_values_of(Parameter& parameter, PbrtTokenizer& tokens, const Declaration& d,
                    const ParameterContext& context) {
    bool words = d.type == ValueType::string || d.type == ValueType::texture ||
                 (d.type == ValueType::spectrum && next_values_are_strings(tokens));
    std::string fault;
    if (words) {
        auto values = read_string_values(tokens, d);
        if (d.type == ValueType::texture && values.size() != 1)
            fault = fmt::format("{} names {} textures; expected 1", d.text(), values.size());
        parameter.values = std::move(values);
    } else if (d.type == ValueType::boolean) {
        parameter.values = read_bool_values(tokens, d);
    } else if (d.type == ValueType::integer) {
        parameter.values = read_number_values<int>(tokens, d);
    } else {
        auto numbers = read_number_values<float>(tokens, d);
        fault = count_fault(d, numbers, context.rgb_lists);
        parameter.values = values_of(d.type, std::move(numbers));
    }
    if (fault.empty()) return true;
    context.messages.add_error(d.place, fault);
    return false;
}

} // namespace

std::vector<Parameter> read_parameters(PbrtTokenizer& tokens, const ParameterContext& context) {
    std::vector<Parameter> parameters;
    while (tokens.peek().kind == Kind::string) {
        Declaration d = read_declaration(tokens, context.messages);
        if (parameters.size() >= most_parameters)
            throw SyntaxError(d.place,
                              fmt::format("more than {} parameters in one directive", most_parameters));
        Parameter parameter;
        parameter.name = d.name;
        parameter.type = d.type;
        parameter.place = d.place;
        parameter.color_space = context.color_space;
        if (!read_values_of(parameter, tokens, d, context)) {
            // A list without brackets leaves numbers behind that would only cause more errors.
            while (tokens.peek().kind == Kind::word && (tokens.peek().text[0] < 'A')) tokens.next();
            continue;
        }
        auto same = std::find_if(parameters.begin(), parameters.end(),
                                 [&](const Parameter& p) { return p.name == d.name; });
        if (same != parameters.end())
            context.messages.add_error(d.place,
                                       fmt::format("parameter \"{}\" is given twice; first at line {}",
                                                   printable(d.name), same->place.line));
        else
            parameters.push_back(std::move(parameter));
    }
    return parameters;
}

} // namespace alhazen
