/// Room on disk for what does not fit into memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <span>

namespace alhazen {

/// A file without a name in the system's temporary folder (TMPDIR, else /tmp): it is gone when the program
/// ends, however it ends. It is opened when it is first needed. May be used from several threads.
class TemporaryFile {
  public:
    TemporaryFile() = default;
    ~TemporaryFile();
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    /// Takes that many bytes at the end of the file, and says where they begin. Throws std::runtime_error
    /// when the folder cannot be written, or has less room than this and as much as is left to others.
    std::uint64_t reserve(std::uint64_t bytes);
    /// Of bytes that are reserved. Throw std::runtime_error.
    void write(std::uint64_t offset, std::span<const std::byte> bytes);
    void read(std::uint64_t offset, std::span<std::byte> bytes) const;
    std::uint64_t size() const;

    /// Free space (bytes) that is left to others.
    static constexpr std::uint64_t left_free = std::uint64_t{256} << 20;

  private:
    mutable std::mutex mutex_;
    std::filesystem::path folder_;
    int descriptor_ = -1;
    std::uint64_t size_ = 0;
};

} // namespace alhazen
