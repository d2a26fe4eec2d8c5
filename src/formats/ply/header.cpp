#include "formats/ply/header.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

namespace alhazen {

namespace {

struct TypeWord {
    std::string_view word;
    PlyType type;
};

// The format's own words, and those with sizes that most programs write today.
constexpr TypeWord type_words[] = {
    {"char", PlyType::i8},   {"int8", PlyType::i8},     {"uchar", PlyType::u8},   {"uint8", PlyType::u8},
    {"short", PlyType::i16}, {"int16", PlyType::i16},   {"ushort", PlyType::u16}, {"uint16", PlyType::u16},
    {"int", PlyType::i32},   {"int32", PlyType::i32},   {"uint", PlyType::u32},   {"uint32", PlyType::u32},
    {"float", PlyType::f32}, {"float32", PlyType::f32}, {"double", PlyType::f64}, {"float64", PlyType::f64}};

std::string shown(std::string_view text) {
    std::string out;
    for (char c : text.substr(0, 40)) out += c >= 0x20 && c < 0x7f ? c : '?';
    return out;
}

class HeaderParser {
  public:
    explicit HeaderParser(std::string_view bytes) : bytes_(bytes) {}

    PlyHeader parse() {
        if (!next_line() || words_.size() != 1 || words_[0] != "ply")
            throw std::runtime_error("line 1: not a PLY file; expected \"ply\"");
        if (!next_line() || words_.empty() || words_[0] != "format") fail("expected \"format\"");
        read_format();
        while (next_line()) {
            if (words_.empty() || words_[0] == "comment" || words_[0] == "obj_info") continue;
            if (words_[0] == "end_header") {
                header_.size = at_;
                header_.lines = line_;
                return std::move(header_);
            }
            if (words_[0] == "element")
                read_element();
            else if (words_[0] == "property")
                read_property();
            else
                fail(fmt::format("unknown word \"{}\" in the header", shown(words_[0])));
        }
        fail("the header has no \"end_header\"");
    }

  private:
    [[noreturn]] void fail(const std::string& text) const {
        throw std::runtime_error(fmt::format("line {}: {}", line_, text));
    }

    bool next_line() {
        if (at_ >= bytes_.size()) return false;
        ++line_;
        std::size_t stop = std::min(bytes_.find('\n', at_), bytes_.size());
        std::string_view line = bytes_.substr(at_, stop - at_);
        at_ = std::min(stop + 1, bytes_.size());
        words_.clear();
        std::size_t i = 0;
        while ((i = line.find_first_not_of(" \t\r", i)) != std::string_view::npos) {
            std::size_t end = std::min(line.find_first_of(" \t\r", i), line.size());
            words_.push_back(line.substr(i, end - i));
            i = end;
            // The rest of a long comment, or of a file that is no PLY, is of no interest.
            if (words_.size() > 8) break;
        }
        return true;
    }

    void read_format() {
        if (words_.size() != 3) fail("expected \"format\", an encoding and a version");
        if (words_[1] == "ascii")
            header_.encoding = PlyHeader::Encoding::ascii;
        else if (words_[1] == "binary_little_endian")
            header_.encoding = PlyHeader::Encoding::little_endian;
        else if (words_[1] == "binary_big_endian")
            header_.encoding = PlyHeader::Encoding::big_endian;
        else
            fail(fmt::format(
                "unknown format \"{}\"; expected ascii, binary_little_endian or binary_big_endian",
                shown(words_[1])));
        if (words_[2] != "1.0")
            fail(fmt::format("unknown format version \"{}\"; expected 1.0", shown(words_[2])));
    }

    void read_element() {
        if (words_.size() != 3) fail("expected \"element\", a name and a count");
        PlyElement element;
        element.name = std::string(words_[1]);
        std::string_view count = words_[2];
        auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
        if (error != std::errc() || end != count.data() + count.size())
            fail(fmt::format("bad count \"{}\" of element \"{}\"; expected a whole number, not negative",
                             shown(count), shown(words_[1])));
        if (header_.find(element.name))
            fail(fmt::format("element \"{}\" is declared twice", shown(words_[1])));
        header_.elements.push_back(std::move(element));
    }

    PlyType type(std::string_view word) const {
        for (const TypeWord& known : type_words)
            if (known.word == word) return known.type;
        fail(fmt::format("unknown property type \"{}\"", shown(word)));
    }

    void read_property() {
        if (header_.elements.empty()) fail("a property before any element");
        PlyProperty property;
        if (words_.size() == 5 && words_[1] == "list") {
            property.is_list = true;
            property.count_type = type(words_[2]);
            property.type = type(words_[3]);
            if (!is_whole(property.count_type)) fail("a list whose length is not of a whole-number type");
        } else if (words_.size() == 3) {
            property.type = type(words_[1]);
        } else {
            fail("expected \"property\", a type and a name");
        }
        property.name = std::string(words_.back());
        header_.elements.back().properties.push_back(std::move(property));
    }

    std::string_view bytes_;
    std::size_t at_ = 0;
    std::size_t line_ = 0;
    std::vector<std::string_view> words_;
    PlyHeader header_;
};

} // namespace

int PlyElement::find(std::string_view property) const {
    for (std::size_t i = 0; i < properties.size(); ++i)
        if (properties[i].name == property) return static_cast<int>(i);
    return -1;
}

const PlyElement* PlyHeader::find(std::string_view element) const {
    for (const PlyElement& e : elements)
        if (e.name == element) return &e;
    return nullptr;
}

PlyHeader parse_ply_header(std::string_view bytes) {
    return HeaderParser(bytes).parse();
}

} // namespace alhazen
