#include "formats/pbrt/tokenizer.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

namespace alhazen {

namespace {

bool is_blank(char c) {
    return c == ' ' || c == '\n' || c == '\t' || c == '\r';
}

// Where a word or a number ends.
bool is_delimiter(char c) {
    return is_blank(c) || c == '"' || c == '[' || c == ']' || c == '#';
}

bool starts_number(char c) {
    return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.';
}

enum class NumberFault { none, malformed, too_large };

// from_chars says "out of range" for numbers too small as well, which are zero (or denormal) to us.
template <class T>
NumberFault rescue_out_of_range(std::string_view digits, T& value) {
    double wide = std::strtod(std::string(digits).c_str(), nullptr);
    if (std::abs(wide) > 1) return NumberFault::too_large;
    value = static_cast<T>(wide);
    return NumberFault::none;
}

// Reads a number from the start of text and sets length to how far it went.
template <class T>
NumberFault parse_number(const char* first, const char* last, T& value, const char*& stop) {
    const char* digits = first;
    if (digits != last && *digits == '+') ++digits;
    const char* unsigned_part = digits;
    if (unsigned_part != last && *unsigned_part == '-' && digits == first) ++unsigned_part;
    stop = first;
    // Shuts out the words inf and nan, which from_chars would take.
    if (unsigned_part == last || !starts_number(*unsigned_part) || *unsigned_part == '-' ||
        *unsigned_part == '+')
        return NumberFault::malformed;
    std::from_chars_result result = std::from_chars(digits, last, value);
    stop = result.ptr;
    bool whole = result.ptr == last || is_delimiter(*result.ptr);
    if (result.ec == std::errc::invalid_argument || !whole) return NumberFault::malformed;
    if (result.ec == std::errc::result_out_of_range) {
        if constexpr (std::is_floating_point_v<T>)
            return rescue_out_of_range(
                std::string_view(digits, static_cast<std::size_t>(result.ptr - digits)), value);
        return NumberFault::too_large;
    }
    return NumberFault::none;
}

template <class T>
[[noreturn]] void throw_bad_number(Place place, std::string_view text, NumberFault fault) {
    constexpr bool whole = std::is_integral_v<T>;
    if (fault == NumberFault::too_large)
        throw SyntaxError(std::move(place), fmt::format("{} is too large for a {}", printable(text),
                                                        whole                      ? "32-bit integer"
                                                        : std::is_same_v<T, float> ? "32-bit float"
                                                                                   : "64-bit float"));
    throw SyntaxError(std::move(place),
                      fmt::format("\"{}\" is not {}", printable(text), whole ? "an integer" : "a number"));
}

} // namespace

std::string printable(std::string_view text) {
    constexpr std::size_t longest = 60;
    std::string shown;
    for (char c : text.substr(0, longest)) {
        auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte == 0x7f)
            shown += fmt::format("\\x{:02x}", byte);
        else
            shown += c;
    }
    if (text.size() > longest) shown += "...";
    return shown;
}

std::string describe_token(const PbrtToken& token) {
    switch (token.kind) {
    case PbrtToken::Kind::end:
        return "the end of the file";
    case PbrtToken::Kind::word:
        return fmt::format("{}", printable(token.text));
    case PbrtToken::Kind::string:
        return fmt::format("the string \"{}\"", printable(token.text));
    case PbrtToken::Kind::open:
        return "\"[\"";
    case PbrtToken::Kind::close:
        return "\"]\"";
    }
    return "";
}

PbrtTokenizer::PbrtTokenizer(std::string_view text, std::shared_ptr<const std::string> file)
    : at_(text.data()), end_(text.data() + text.size()), line_start_(at_), file_(std::move(file)) {
    if (text.starts_with("\xef\xbb\xbf")) line_start_ = at_ += 3;
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) {
        Place place{file_, 1, 1};
        at_ = end_;
        throw SyntaxError(std::move(place), "the file is in UTF-16; expected ASCII or UTF-8");
    }
}

void PbrtTokenizer::skip_blank() {
    for (; at_ != end_; ++at_) {
        if (*at_ == '\n') {
            ++line_;
            line_start_ = at_ + 1;
        } else if (*at_ == '#') {
            while (at_ + 1 != end_ && at_[1] != '\n' && at_[1] != '\r') ++at_;
        } else if (!is_blank(*at_)) {
            return;
        }
    }
}

const PbrtToken& PbrtTokenizer::peek() {
    if (!has_ahead_) {
        ahead_ = read_token();
        has_ahead_ = true;
    }
    return ahead_;
}

PbrtToken PbrtTokenizer::next() {
    if (!has_ahead_) return read_token();
    has_ahead_ = false;
    return ahead_;
}

PbrtToken PbrtTokenizer::read_token() {
    skip_blank();
    PbrtToken token;
    token.line = line_;
    token.column = static_cast<std::uint32_t>(at_ - line_start_) + 1;
    if (at_ == end_) return token;
    if (*at_ == '"') return read_string(token);
    if (*at_ == '[' || *at_ == ']') {
        token.kind = *at_ == '[' ? PbrtToken::Kind::open : PbrtToken::Kind::close;
        token.text = {at_++, 1};
        return token;
    }
    return read_word(token);
}

PbrtToken PbrtTokenizer::read_string(PbrtToken token) {
    const char* first = ++at_;
    while (at_ != end_ && *at_ != '"' && *at_ != '\n') {
        if (*at_ == '\0') {
            ++at_;
            throw SyntaxError(place(token), "a string with a zero byte in it");
        }
        // An escaped character never ends the string, be it a quote.
        if (*at_ == '\\' && at_ + 1 != end_ && at_[1] != '\n') ++at_;
        ++at_;
    }
    token.kind = PbrtToken::Kind::string;
    token.text = {first, static_cast<std::size_t>(at_ - first)};
    if (at_ == end_ || *at_ == '\n')
        throw SyntaxError(place(token),
                          fmt::format("unterminated string \"{}; expected a closing quote on the same line",
                                      printable(token.text)));
    ++at_;
    return token;
}

PbrtToken PbrtTokenizer::read_word(PbrtToken token) {
    const char* first = at_;
    while (at_ != end_ && !is_delimiter(*at_)) ++at_;
    token.kind = PbrtToken::Kind::word;
    token.text = {first, static_cast<std::size_t>(at_ - first)};
    auto byte = static_cast<unsigned char>(*first);
    if (byte < 0x20 || byte == 0x7f)
        throw SyntaxError(place(token), fmt::format("stray character \\x{:02x}", byte));
    return token;
}

template <class T>
void PbrtTokenizer::read_numbers(std::vector<T>& out) {
    // A few at a time: most lists are short, and then take the memory that they need at once.
    std::array<T, 16> few;
    std::size_t count = 0;
    const auto hand_over = [&] {
        out.insert(out.end(), few.begin(), few.begin() + static_cast<std::ptrdiff_t>(count));
        count = 0;
    };
    for (;;) {
        skip_blank();
        if (at_ == end_ || !starts_number(*at_)) return hand_over();
        T value{};
        const char* stop = at_;
        NumberFault fault = parse_number(at_, end_, value, stop);
        if (fault != NumberFault::none) {
            hand_over();
            Place where = place();
            PbrtToken word = read_token();
            throw_bad_number<T>(std::move(where), word.text, fault);
        }
        at_ = stop;
        few[count++] = value;
        if (count == few.size()) hand_over();
    }
}

template <class T>
T PbrtTokenizer::number(const PbrtToken& token) const {
    T value{};
    const char* stop = nullptr;
    const char* last = token.text.data() + token.text.size();
    NumberFault fault = parse_number(token.text.data(), last, value, stop);
    if (fault != NumberFault::none) throw_bad_number<T>(place(token), token.text, fault);
    return value;
}

template void PbrtTokenizer::read_numbers(std::vector<float>&);
template void PbrtTokenizer::read_numbers(std::vector<double>&);
template void PbrtTokenizer::read_numbers(std::vector<int>&);
template double PbrtTokenizer::number(const PbrtToken&) const;
template float PbrtTokenizer::number(const PbrtToken&) const;
template int PbrtTokenizer::number(const PbrtToken&) const;

std::string PbrtTokenizer::string(const PbrtToken& token) const {
    if (token.text.find('\\') == std::string_view::npos) return std::string(token.text);
    constexpr std::string_view escapes = "bfnrt\\'\"";
    constexpr std::string_view meanings = "\b\f\n\r\t\\'\"";
    std::string value;
    for (std::size_t i = 0; i < token.text.size(); ++i) {
        if (token.text[i] != '\\') {
            value += token.text[i];
            continue;
        }
        ++i; // the tokenizer never ends a string on a lone backslash
        std::size_t which = escapes.find(token.text[i]);
        if (which == std::string_view::npos)
            throw SyntaxError(
                place(token),
                fmt::format("unknown escape \\{} in a string; known: \\b \\f \\n \\r \\t \\\\ \\' \\\"",
                            printable(token.text.substr(i, 1))));
        value += meanings[which];
    }
    return value;
}

} // namespace alhazen
