/// Text to words, strings, brackets and numbers, as pbrt-v4's scene language has them. Works straight out of
/// the file's bytes: arrays of numbers, nearly all of a large scene, are read without a token or a copy for
/// each.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/messages.h"

namespace alhazen {

/// A place where the text cannot be read on; the parser reports it and goes on at the next directive.
struct SyntaxError : std::runtime_error {
    SyntaxError(Place place_, const std::string& text) : std::runtime_error(text), place(std::move(place_)) {}
    Place place;
};

struct PbrtToken {
    enum class Kind { end, word, string, open, close };
    Kind kind = Kind::end;
    std::string_view text; ///< of a string: what is between the quotes, escapes not yet undone
    std::uint32_t line = 1, column = 1;
};

/// text as messages show it: cut to a sensible length, bytes that do not print as \xNN.
std::string printable(std::string_view text);
/// What a token is, for messages: the string "x", the word x, "[", the end of the file.
std::string describe_token(const PbrtToken& token);

class PbrtTokenizer {
  public:
    /// text must outlive the tokenizer and its tokens.
    PbrtTokenizer(std::string_view text, std::shared_ptr<const std::string> file);

    /// The next token; kind end, again and again, after the last. Throws SyntaxError (after which the text
    /// behind the bad part can be read on).
    PbrtToken next();
    const PbrtToken& peek();
    /// Makes token, the last that next() gave, the next again.
    void put_back(const PbrtToken& token) {
        ahead_ = token;
        has_ahead_ = true;
    }

    /// Appends the numbers that follow, up to the first thing that is not one. Must not be called between
    /// peek and next. T: float, double, int. Throws SyntaxError at a malformed or too large number.
    template <class T>
    void read_numbers(std::vector<T>& out);
    /// One number, read as T.
    template <class T>
    T number(const PbrtToken& token) const;
    /// The characters of a string token, escapes undone.
    std::string string(const PbrtToken& token) const;

    Place place(const PbrtToken& token) const { return {file_, token.line, token.column}; }
    Place place() const { return {file_, line_, static_cast<std::uint32_t>(at_ - line_start_) + 1}; }

  private:
    void skip_blank();
    PbrtToken read_token();
    PbrtToken read_string(PbrtToken token);
    PbrtToken read_word(PbrtToken token);

    const char* at_;
    const char* end_;
    const char* line_start_;
    std::uint32_t line_ = 1;
    std::shared_ptr<const std::string> file_;
    PbrtToken ahead_;
    bool has_ahead_ = false;
};

} // namespace alhazen
