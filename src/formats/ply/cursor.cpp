#include "formats/ply/cursor.h"

#include <charconv>
#include <cstdlib>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

namespace alhazen {

namespace {

bool is_blank(char c) {
    return c == ' ' || c == '\n' || c == '\t' || c == '\r';
}

std::string early_end(const PlyProgress& progress) {
    return fmt::format("the file ends in {} {}", progress.element, progress.number);
}

} // namespace

std::string PlyAsciiCursor::located(const std::string& text) const {
    // Only counted now: lines matter to nobody while all is well.
    auto first = bytes_.begin() + static_cast<std::ptrdiff_t>(start_);
    auto last = bytes_.begin() + static_cast<std::ptrdiff_t>(at_);
    auto line = header_lines_ + 1 + static_cast<std::size_t>(std::count(first, last, '\n'));
    return fmt::format("line {}: {}", line, text);
}

std::string_view PlyAsciiCursor::word() {
    while (at_ < bytes_.size() && is_blank(bytes_[at_])) ++at_;
    if (at_ == bytes_.size()) fail(early_end(progress));
    std::size_t first = at_;
    while (at_ < bytes_.size() && !is_blank(bytes_[at_])) ++at_;
    return bytes_.substr(first, at_ - first);
}

float PlyAsciiCursor::real(PlyType) {
    std::string_view text = word();
    if (text.starts_with('+')) text.remove_prefix(1);
    float value = 0;
    auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size() || error == std::errc::invalid_argument)
        fail(fmt::format("expected a number in {} {}, found \"{}\"", progress.element, progress.number,
                         text.substr(0, 40)));
    // Too large (taken for infinite, and reported as such) or so small that it is zero.
    if (error == std::errc::result_out_of_range) value = std::strtof(std::string(text).c_str(), nullptr);
    return value;
}

std::int64_t PlyAsciiCursor::whole(PlyType) {
    std::string_view text = word();
    std::int64_t value = 0;
    auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size() || error != std::errc())
        fail(fmt::format("expected a whole number in {} {}, found \"{}\"", progress.element, progress.number,
                         text.substr(0, 40)));
    return value;
}

template <bool swap>
std::string PlyBinaryCursor<swap>::located(const std::string& text) const {
    return fmt::format("byte {}: {}", at_, text);
}

template <bool swap>
void PlyBinaryCursor<swap>::need(std::size_t bytes) const {
    if (left() < bytes) fail(early_end(progress));
}

template class PlyBinaryCursor<false>;
template class PlyBinaryCursor<true>;

} // namespace alhazen
