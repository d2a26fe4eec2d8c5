#include "render/manual.h"

#include <sstream>

#include <fmt/format.h>

#include "color/spectral.h"

namespace alhazen {

namespace {

std::string wrapped(const std::string& text, int columns, const std::string& indent) {
    std::istringstream words(text);
    std::string out, line = indent, word;
    while (words >> word) {
        if (line.size() > indent.size() &&
            line.size() + 1 + word.size() > static_cast<std::size_t>(columns)) {
            out += line + "\n";
            line = indent;
        }
        line += (line.size() > indent.size() ? " " : "") + word;
    }
    return out + line + "\n";
}

std::string escaped(std::string text) {
    std::string out;
    for (char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
    return out;
}

std::string default_words(const FieldDoc& field) {
    return field.is_required ? "required" : field.default_text;
}

std::string value_text(const Parameter& p) {
    std::string out;
    auto add = [&](const auto& values) {
        using E = typename std::decay_t<decltype(values)>::value_type;
        for (const E& v : values) {
            if (!out.empty()) out += ' ';
            if constexpr (std::is_same_v<E, std::string>)
                out += '"' + v + '"';
            else if constexpr (std::is_same_v<E, std::uint8_t>)
                out += v ? "true" : "false";
            else if constexpr (std::is_same_v<E, Vec2>)
                out += fmt::format("{} {}", v.x, v.y);
            else if constexpr (std::is_same_v<E, Vec3>)
                out += fmt::format("{} {} {}", v.x, v.y, v.z);
            else
                out += fmt::format("{}", v);
        }
    };
    std::visit(add, p.values);
    return fmt::format("\"{} {}\" [ {} ]", type_name(p.type), p.name, out);
}

// An example as one would write it in a scene.
std::string example_text(const FamilyInfo& family, const KindDoc& kind, const Example& example) {
    std::string out = fmt::format("{} \"{}\"", family.directive, kind.name);
    for (const Parameter& p : example.parameters) out += "\n    " + value_text(p);
    return out;
}

std::string range_and_unit(const FieldDoc& field) {
    std::string text = field.range_text();
    if (!field.unit.empty()) text += (text.empty() ? "" : ", ") + field.unit;
    return text;
}

} // namespace

std::string kind_text(const FamilyInfo& family, const KindDoc& kind, int columns) {
    std::string out =
        fmt::format("{} \"{}\"\n\n", family.directive, kind.name) + wrapped(kind.about, columns, "  ");
    if (!kind.fields.empty()) out += "\nParameters:\n";
    for (const FieldDoc& f : kind.fields) {
        out += fmt::format("  {}  ({}){}\n", f.name, f.type,
                           f.is_required ? "  required" : fmt::format("  default {}", f.default_text));
        std::string extra = range_and_unit(f);
        out += wrapped(f.meaning + (extra.empty() ? "" : "; " + extra), columns, "      ");
    }
    for (const Example& e : kind.examples)
        out += fmt::format("\nExample, {}:\n", e.name) + example_text(family, kind, e) + "\n";
    return out;
}

std::string spectra_text(int columns) {
    std::string names;
    for (const std::string& name : spectrum_names()) names += name + " ";
    return "Colours in a scene:\n"
           "  \"rgb NAME\" [ .6 .4 .3 ]              in the colour space in effect (sRGB unless ColorSpace "
           "says)\n"
           "  \"blackbody NAME\" 3000                light of a black body, kelvins\n"
           "  \"spectrum NAME\" \"metal-Au-eta\"      a spectrum by name, or a file of nm-value pairs\n"
           "  \"spectrum NAME\" [ 400 .1 700 .9 ]    samples: nm and value\n"
           "  \"float NAME\" .5                      the same at all wavelengths\n\n"
           "Spectra with names:\n" +
           wrapped(names, columns, "  ");
}

std::string family_text(const FamilyInfo& family) {
    std::string out = fmt::format("{}: {}\n\n", family.name, family.about);
    const std::vector<KindDoc> kinds = family.kinds();
    std::size_t width = 16;
    for (const KindDoc& kind : kinds) width = std::max(width, kind.name.size());
    for (const KindDoc& kind : kinds) out += fmt::format("  {:<{}}{}\n", kind.name, width + 2, kind.about);
    return out;
}

std::string family_markdown(const FamilyInfo& family) {
    std::string out = fmt::format("# {}\n\n{} In a pbrt scene: `{} \"type\" ...`\n", family.name,
                                  family.about, family.directive);
    for (const KindDoc& kind : family.kinds()) {
        out += fmt::format("\n## {}\n\n{}\n", kind.name, kind.about);
        if (!kind.fields.empty())
            out += "\n| parameter | type | default | meaning | range, unit |\n|---|---|---|---|---|\n";
        for (const FieldDoc& f : kind.fields)
            out += fmt::format("| `{}` | {} | {} | {} | {} |\n", f.name, escaped(f.type),
                               escaped(default_words(f)), escaped(f.meaning), range_and_unit(f));
        for (const Example& e : kind.examples)
            out += fmt::format("\nExample, {}:\n\n```\n{}\n```\n", e.name, example_text(family, kind, e));
    }
    return out;
}

} // namespace alhazen
