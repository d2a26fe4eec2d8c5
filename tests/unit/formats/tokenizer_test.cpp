#include "formats/pbrt/tokenizer.h"

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace alhazen {
namespace {

using Kind = PbrtToken::Kind;

PbrtTokenizer tokenizer(std::string_view text) {
    return PbrtTokenizer(text, std::make_shared<const std::string>("f"));
}

std::string fault_of(std::string_view text) {
    try {
        PbrtTokenizer t = tokenizer(text);
        while (t.next().kind != Kind::end) {
        }
    } catch (const SyntaxError& error) {
        return error.place.text() + ": " + error.what();
    }
    return "";
}

TEST(PbrtTokenizer, TellsWordsStringsAndBracketsWithTheirPlaces) {
    PbrtTokenizer t = tokenizer("Shape\t\"a b\"\r\n  [1]#c ]\n# \"\nend");
    struct Expected {
        Kind kind;
        std::string_view text;
        std::uint32_t line, column;
    };
    for (Expected e : {Expected{Kind::word, "Shape", 1, 1},
                       {Kind::string, "a b", 1, 7},
                       {Kind::open, "[", 2, 3},
                       {Kind::word, "1", 2, 4},
                       {Kind::close, "]", 2, 5},
                       {Kind::word, "end", 4, 1},
                       {Kind::end, "", 4, 4},
                       {Kind::end, "", 4, 4}}) {
        PbrtToken token = t.next();
        EXPECT_EQ(token.kind, e.kind);
        EXPECT_EQ(token.text, e.text);
        EXPECT_EQ(token.line, e.line);
        EXPECT_EQ(token.column, e.column);
    }
}

TEST(PbrtTokenizer, PeekDoesNotTake) {
    PbrtTokenizer t = tokenizer("a b");
    EXPECT_EQ(t.peek().text, "a");
    EXPECT_EQ(t.peek().text, "a");
    EXPECT_EQ(t.next().text, "a");
    EXPECT_EQ(t.next().text, "b");
}

TEST(PbrtTokenizer, UndoesEscapes) {
    PbrtTokenizer t = tokenizer(R"("a\"b\\\n\t\'\r\b\f")");
    EXPECT_EQ(t.string(t.next()), "a\"b\\\n\t'\r\b\f");
}

TEST(PbrtTokenizer, SkipsAByteOrderMark) {
    PbrtTokenizer t = tokenizer("\xef\xbb\xbfWorldBegin");
    PbrtToken token = t.next();
    EXPECT_EQ(token.text, "WorldBegin");
    EXPECT_EQ(token.column, 1u);
}

TEST(PbrtTokenizer, ReadsNumbersExactly) {
    // The decimal expansion decides between two floats beyond the 20th digit: 2^24 + 1 + 1e-13 rounds up.
    PbrtTokenizer t =
        tokenizer("1 -2 +3 .5 -.5 5. 1e3 1E-3 0x 16777217.0000000000001 1e-50 1e-42 3.4028235e38 x");
    std::vector<float> v;
    EXPECT_THROW(t.read_numbers(v), SyntaxError); // 0x
    t.read_numbers(v);
    std::vector<float> expected{1, -2, 3, 0.5f, -0.5f, 5, 1000, 0.001f, 16777218.f, 0, 1e-42f, 3.4028235e38f};
    EXPECT_EQ(v, expected);
    EXPECT_EQ(t.next().text, "x");
}

TEST(PbrtTokenizer, ReadsListsOfAnyLength) {
    for (int n : {0, 1, 15, 16, 17, 32, 33, 1000}) {
        std::string text;
        std::vector<int> expected{-1};
        for (int i = 0; i < n; ++i) {
            text += fmt::format("{} ", i);
            expected.push_back(i);
        }
        text += "]";
        PbrtTokenizer t = tokenizer(text);
        std::vector<int> v{-1}; // what is there already stays
        t.read_numbers(v);
        EXPECT_EQ(v, expected);
        EXPECT_EQ(t.next().text, "]");
    }
}

TEST(PbrtTokenizer, ReadsNumbersAcrossLinesAndComments) {
    PbrtTokenizer t = tokenizer("1 # 2\n3\r\n4]");
    std::vector<int> v;
    t.read_numbers(v);
    EXPECT_EQ(v, (std::vector<int>{1, 3, 4}));
    PbrtToken close = t.next();
    EXPECT_EQ(close.line, 3u);
    EXPECT_EQ(close.column, 2u);
}

TEST(PbrtTokenizer, SaysWhatIsWrong) {
    EXPECT_EQ(fault_of("a \"b\nc"),
              "f:1:3: unterminated string \"b; expected a closing quote on the same line");
    EXPECT_EQ(fault_of("\"b"), "f:1:1: unterminated string \"b; expected a closing quote on the same line");
    EXPECT_EQ(fault_of("\"b\\"),
              "f:1:1: unterminated string \"b\\; expected a closing quote on the same line");
    EXPECT_EQ(fault_of(std::string_view("a \0b", 4)), "f:1:3: stray character \\x00");
    EXPECT_EQ(fault_of(std::string_view("\"a\0b\"", 5)), "f:1:1: a string with a zero byte in it");
    EXPECT_EQ(fault_of("\xff\xfeW"), "f:1:1: the file is in UTF-16; expected ASCII or UTF-8");
}

template <class T>
std::string number_fault(std::string_view text) {
    PbrtTokenizer t = tokenizer(text);
    try {
        (void)t.number<T>(t.next());
    } catch (const SyntaxError& error) {
        return error.what();
    }
    return "";
}

TEST(PbrtTokenizer, RefusesWhatIsNoNumber) {
    EXPECT_EQ(number_fault<float>("1e39"), "1e39 is too large for a 32-bit float");
    EXPECT_EQ(number_fault<float>("-1e999"), "-1e999 is too large for a 32-bit float");
    EXPECT_EQ(number_fault<double>("1e999"), "1e999 is too large for a 64-bit float");
    EXPECT_EQ(number_fault<int>("2147483648"), "2147483648 is too large for a 32-bit integer");
    EXPECT_EQ(number_fault<int>("-2147483648"), "");
    EXPECT_EQ(number_fault<int>("1.5"), "\"1.5\" is not an integer");
    for (std::string text : {"nan", "inf", "-inf", "1.2.3", "--1", "+-1", "-", "+", ".", "1f", "0x10", "e5"})
        EXPECT_EQ(number_fault<float>(text), "\"" + text + "\" is not a number");
}

TEST(PbrtTokenizer, ShowsOddTextReadably) {
    EXPECT_EQ(printable(std::string_view("a\0\x1b[", 4)), "a\\x00\\x1b[");
    EXPECT_EQ(printable(std::string(100, 'x')), std::string(60, 'x') + "...");
}

} // namespace
} // namespace alhazen
