/// The page of docs that shows how scenes compare.
#pragma once

#include <filesystem>

namespace alhazen::bench {

/// Puts a table and pictures of the records in a folder between the page's marks; the pictures go into the
/// folder images/validation beside the page. Throws std::runtime_error when the page has no marks.
void write_validation_page(const std::filesystem::path& records, const std::filesystem::path& page);

} // namespace alhazen::bench
