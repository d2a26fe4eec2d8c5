#include "base/temporary_file.h"

#include <cerrno>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include <fmt/format.h>

namespace alhazen {

namespace {

[[noreturn]] void fail(std::string_view what, int error) {
    throw std::runtime_error(
        fmt::format("temporary file: {} ({})", what, std::generic_category().message(error)));
}

int open_nameless(const std::filesystem::path& folder) {
    int file = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (file >= 0) return file;
    // Not all file systems have nameless files; then the name is taken away at once.
    std::string name = (folder / "alhazen-XXXXXX").string();
    file = mkostemp(name.data(), O_CLOEXEC);
    if (file < 0) fail(fmt::format("cannot write in the folder {}", folder.string()), errno);
    unlink(name.c_str());
    return file;
}

[[noreturn]] void fail_for_room(const std::filesystem::path& folder, std::uint64_t wanted,
                                std::uint64_t available) {
    constexpr double mb = 1e6;
    throw std::runtime_error(
        fmt::format("{:.1f} MB more are needed in the temporary folder {}, where {:.1f} MB are free, {:.1f} "
                    "MB of which are left to others; the environment variable TMPDIR names another folder",
                    static_cast<double>(wanted) / mb, folder.string(), static_cast<double>(available) / mb,
                    static_cast<double>(TemporaryFile::left_free) / mb));
}

} // namespace

TemporaryFile::~TemporaryFile() {
    if (descriptor_ >= 0) close(descriptor_);
}

std::uint64_t TemporaryFile::reserve(std::uint64_t bytes) {
    std::lock_guard lock(mutex_);
    if (descriptor_ < 0) {
        std::error_code error;
        folder_ = std::filesystem::temp_directory_path(error);
        if (error)
            fail("there is no folder for it where the environment variable TMPDIR says", error.value());
        descriptor_ = open_nameless(folder_);
    }
    std::error_code unknown;
    const auto space = std::filesystem::space(folder_, unknown);
    const bool is_known = !unknown;
    if (is_known && (space.available < left_free || space.available - left_free < bytes))
        fail_for_room(folder_, bytes, space.available);
    const int error = posix_fallocate(descriptor_, static_cast<off_t>(size_), static_cast<off_t>(bytes));
    if (error == ENOSPC && is_known) fail_for_room(folder_, bytes, space.available);
    if (error != 0) fail("cannot make it larger", error);
    const std::uint64_t offset = size_;
    size_ += bytes;
    return offset;
}

void TemporaryFile::write(std::uint64_t offset, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t n = pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) fail("cannot write", errno);
        bytes = bytes.subspan(static_cast<std::size_t>(n));
        offset += static_cast<std::uint64_t>(n);
    }
}

void TemporaryFile::read(std::uint64_t offset, std::span<std::byte> bytes) const {
    while (!bytes.empty()) {
        const ssize_t n = pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) fail("cannot read", errno);
        if (n == 0) throw std::runtime_error("temporary file: it ends too early");
        bytes = bytes.subspan(static_cast<std::size_t>(n));
        offset += static_cast<std::uint64_t>(n);
    }
}

std::uint64_t TemporaryFile::size() const {
    std::lock_guard lock(mutex_);
    return size_;
}

} // namespace alhazen
