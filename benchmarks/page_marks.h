/// Pages of docs/ hold figures that programs put there, between two marks.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "base/file.h"

namespace alhazen::bench {

/// Puts text between "<!-- NAME -->" and "<!-- end of NAME -->", in the place of what stood there. Throws
/// std::runtime_error when the page has no such marks.
inline void put_between_marks(const std::filesystem::path& page, const std::string& name,
                              const std::string& text) {
    const std::string begin_mark = fmt::format("<!-- {} -->", name),
                      end_mark = fmt::format("<!-- end of {} -->", name);
    const std::string before = read_file(page);
    const std::size_t begin = before.find(begin_mark), end = before.find(end_mark);
    if (begin == std::string::npos || end == std::string::npos || end < begin)
        throw std::runtime_error(
            fmt::format("{}: the page has no marks {} and {}", page.string(), begin_mark, end_mark));
    write_file(page, before.substr(0, begin + begin_mark.size()) + "\n" + text + before.substr(end));
}

} // namespace alhazen::bench
