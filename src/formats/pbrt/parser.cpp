#include "formats/pbrt/parser.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/file.h"
#include "formats/pbrt/directives.h"
#include "formats/pbrt/parameters.h"
#include "formats/pbrt/version3.h"

namespace alhazen {

using Kind = PbrtToken::Kind;

Place PbrtParser::parse(std::string_view text, std::shared_ptr<const std::string> file_name,
                        const std::filesystem::path& path) {
    Place start{file_name, 1, 1};
    try {
        PbrtTokenizer tokens(text, std::move(file_name));
        open_.push_back({&tokens, path});
        for (;;) {
            try {
                PbrtToken word = tokens.next();
                if (word.kind == Kind::end) break;
                read_directive(word);
            } catch (const SyntaxError& error) {
                builder_.messages().add_error(error.place, error.what());
                skip_to_directive();
            }
        }
        open_.pop_back();
        return tokens.place();
    } catch (const SyntaxError& error) { // of the file as a whole
        builder_.messages().add_error(error.place, error.what());
        return start;
    }
}

void PbrtParser::read_directive(const PbrtToken& word) {
    Place place = tokens().place(word);
    // Directives begin with a letter; a number is a value too many.
    bool is_name = word.kind == Kind::word && (word.text[0] < '+' || word.text[0] > '9');
    if (!is_name)
        throw SyntaxError(std::move(place),
                          fmt::format("expected a directive, found {}", describe_token(word)));
    if (const auto* entry = DirectiveTable::find(word.text)) {
        entry->run(*this, builder_, std::move(place));
        return;
    }
    if (const OldName* old = find_old_name("directive", "", word.text)) {
        builder_.messages().add_unsupported(std::move(place), describe_old_name(*old), Remedy::leave_out());
        skip_to_directive();
        return;
    }
    std::vector<std::string> known;
    for (const auto& entry : DirectiveTable::entries) known.emplace_back(entry.word);
    std::string nearest = nearest_name(word.text, known);
    throw SyntaxError(std::move(place),
                      fmt::format("unknown directive {}{}", printable(word.text),
                                  nearest.empty() ? "" : fmt::format(" (did you mean {}?)", nearest)));
}

void PbrtParser::skip_to_directive() {
    for (;;) {
        try {
            const PbrtToken& token = tokens().peek();
            if (token.kind == Kind::end || (token.kind == Kind::word && DirectiveTable::find(token.text)))
                return;
            tokens().next();
        } catch (const SyntaxError&) {
            // Already off the track: only the first fault is worth a message.
        }
    }
}

void PbrtParser::fail_at(const PbrtToken& token, const std::string& text) {
    tokens().put_back(token);
    throw SyntaxError(tokens().place(token), text);
}

std::string PbrtParser::string(std::string_view what) {
    PbrtToken token = tokens().next();
    if (token.kind != Kind::string)
        fail_at(token, fmt::format("expected {} in quotes, found {}", what, describe_token(token)));
    return tokens().string(token);
}

template <std::size_t n>
std::array<double, n> PbrtParser::numbers(std::string_view directive) {
    std::array<double, n> values{};
    for (std::size_t i = 0; i < n; ++i) {
        PbrtToken token = tokens().next();
        const bool may_be_directive = token.kind == Kind::word && token.text[0] >= 'A';
        if (token.kind != Kind::word || (may_be_directive && DirectiveTable::find(token.text)))
            fail_at(token, fmt::format("{} needs {} numbers; found {} after {}", directive, n,
                                       describe_token(token), i));
        values[i] = tokens().number<double>(token);
    }
    return values;
}

template std::array<double, 2> PbrtParser::numbers(std::string_view);
template std::array<double, 3> PbrtParser::numbers(std::string_view);
template std::array<double, 4> PbrtParser::numbers(std::string_view);
template std::array<double, 9> PbrtParser::numbers(std::string_view);

std::array<double, 16> PbrtParser::matrix(std::string_view directive) {
    PbrtToken open = tokens().next();
    if (open.kind != Kind::open)
        fail_at(open,
                fmt::format("{} needs 16 numbers in brackets; found {}", directive, describe_token(open)));
    auto values = numbers<16>(directive);
    PbrtToken close = tokens().next();
    if (close.kind != Kind::close)
        fail_at(close, fmt::format("{} needs 16 numbers in brackets; found {} after 16", directive,
                                   describe_token(close)));
    return values;
}

Node PbrtParser::node(const Place& place, bool rgb_lists) {
    Node node;
    node.type = string("a type");
    node.place = place;
    node.color_space = &builder_.color_space();
    node.parameters =
        read_parameters(tokens(), {builder_.messages(), builder_.color_space().name, rgb_lists});
    return node;
}

void PbrtParser::medium_interface(Place place) {
    std::string inside = string("a medium's name");
    std::string outside = tokens().peek().kind == Kind::string ? string("a medium's name") : inside;
    builder_.medium_interface(std::move(inside), std::move(outside), std::move(place));
}

void PbrtParser::texture(Place place) {
    std::string name = string("a texture's name");
    std::string value_type = string("\"float\" or \"spectrum\"");
    Node texture = node(place);
    texture.name = std::move(name);
    builder_.texture(std::move(texture), value_type, std::move(place));
}

void PbrtParser::sdf(Place place) {
    std::string name = string("an sdf's name");
    Node sdf = node(place);
    sdf.name = std::move(name);
    builder_.sdf(std::move(sdf), std::move(place));
}

void PbrtParser::option(Place place) {
    std::string name = string("an option's name");
    // pbrt's manual writes the type before the name, its scenes do not.
    name.erase(0, name.find_last_of(' ') + 1);
    PbrtToken token = tokens().next();
    bool bracketed = token.kind == Kind::open;
    if (bracketed) token = tokens().next();
    Parameter value;
    value.place = tokens().place(token);
    if (token.kind == Kind::string) {
        value.type = ValueType::string;
        value.values = std::vector<std::string>{tokens().string(token)};
    } else if (token.kind == Kind::word && (token.text == "true" || token.text == "false")) {
        value.type = ValueType::boolean;
        value.values = std::vector<std::uint8_t>{static_cast<std::uint8_t>(token.text == "true")};
    } else if (token.kind == Kind::word && !DirectiveTable::find(token.text)) {
        value.values = std::vector<float>{tokens().number<float>(token)};
    } else {
        fail_at(token, fmt::format("expected a value for the option \"{}\", found {}", printable(name),
                                   describe_token(token)));
    }
    if (bracketed) token = tokens().next();
    if (bracketed && token.kind != Kind::close)
        fail_at(token, fmt::format("expected \"]\" after one value, found {}", describe_token(token)));
    builder_.option(name, std::move(value), std::move(place));
}

void PbrtParser::resolve_and_parse(const std::string& name, const Place& place) {
    std::filesystem::path path = base_folder_ / std::filesystem::path(name);
    std::filesystem::path real = real_path(path);
    for (const OpenFile& file : open_)
        if (!file.path.empty() && file.path == real)
            throw SyntaxError(place, fmt::format("\"{}\" includes itself", printable(name)));
    if (open_.size() > deepest_includes)
        throw SyntaxError(place, fmt::format("files included more than {} deep", deepest_includes));
    if (++includes_ > most_includes)
        throw SyntaxError(place, fmt::format("more than {} files included", most_includes));
    std::string text;
    try {
        text = read_file(path);
    } catch (const std::runtime_error& error) {
        throw SyntaxError(place, fmt::format("cannot read \"{}\": {}", printable(name), error.what()));
    }
    parse(text, std::make_shared<const std::string>(path.lexically_normal().string()), real);
}

void PbrtParser::import(const std::string& name, Place place) {
    if (!builder_.in_world())
        throw SyntaxError(std::move(place), "Import before WorldBegin; expected it after");
    ImportScope importer = builder_.begin_import();
    try {
        resolve_and_parse(name, place);
    } catch (const SyntaxError&) {
        builder_.end_import(std::move(importer));
        throw;
    }
    builder_.end_import(std::move(importer));
}

} // namespace alhazen
