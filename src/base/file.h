/// Files: read whole (gzip undone), written under a temporary name and renamed; paths that are one file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace alhazen {

/// The bytes of a file; gzip-compressed files (by their first two bytes, whatever the name) are decompressed.
/// Throws std::runtime_error whose text says what failed ("no such file", "is a directory", "truncated gzip
/// data", "larger than ... bytes when decompressed") without naming the file.
std::string read_file(const std::filesystem::path& path, std::size_t max_bytes = std::size_t{16} << 30);

/// One path for all the spellings of a file's: absolute, without "..", links followed as far as there are
/// files. As it is where that cannot be found out.
std::filesystem::path real_path(const std::filesystem::path& path);

/// Whether there is something that is written to as it is, and not replaced: a pipe, a device, /dev/stdout.
bool is_stream(const std::filesystem::path& path);

/// Calls write with a temporary path beside the target, then renames it over the target: readers see the old
/// file or the whole new one. The temporary is removed when write throws. The target is the file of that
/// name, or the one that a link of that name leads to; a stream is given to write itself. Throws
/// std::runtime_error when the folder cannot be written.
void write_atomically(const std::filesystem::path& named,
                      const std::function<void(const std::filesystem::path& temporary)>& write);
void write_file(const std::filesystem::path& target, std::string_view bytes);

} // namespace alhazen
