#include "base/file.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <system_error>

#include <unistd.h>

#include <fmt/format.h>
#include <zlib.h>

namespace alhazen {

namespace {

std::string read_plain(const std::filesystem::path& path, std::size_t max_bytes) {
    std::ifstream in(path, std::ios::binary);
    if (!in)
        throw std::runtime_error(fmt::format("cannot open ({})", std::generic_category().message(errno)));
    std::string bytes;
    std::error_code ignored;
    auto size = std::filesystem::file_size(path, ignored);
    if (!ignored) {
        if (size > max_bytes) throw std::runtime_error(fmt::format("larger than {} bytes", max_bytes));
        bytes.resize(static_cast<std::size_t>(size));
        in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        bytes.resize(static_cast<std::size_t>(in.gcount()));
    }
    // Pipes and files that grow have no size to trust.
    std::array<char, 65536> buffer;
    while (in && (in.read(buffer.data(), buffer.size()) || in.gcount() > 0)) {
        bytes.append(buffer.data(), static_cast<std::size_t>(in.gcount()));
        if (bytes.size() > max_bytes)
            throw std::runtime_error(fmt::format("larger than {} bytes", max_bytes));
    }
    return bytes;
}

std::string decompress(std::string_view packed, std::size_t max_bytes) {
    z_stream stream{};
    if (inflateInit2(&stream, 15 + 32) != Z_OK) throw std::runtime_error("cannot start decompression");
    std::unique_ptr<z_stream, int (*)(z_stream*)> guard(&stream, inflateEnd);
    std::string out;
    std::array<char, 65536> buffer;
    std::size_t consumed = 0;
    for (;;) {
        // zlib counts input in 32 bits, so it is handed over in pieces.
        if (stream.avail_in == 0 && consumed < packed.size()) {
            std::size_t piece = std::min<std::size_t>(packed.size() - consumed, std::size_t{1} << 30);
            stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + consumed));
            stream.avail_in = static_cast<uInt>(piece);
            consumed += piece;
        }
        stream.next_out = reinterpret_cast<Bytef*>(buffer.data());
        stream.avail_out = static_cast<uInt>(buffer.size());
        int status = inflate(&stream, Z_NO_FLUSH);
        out.append(buffer.data(), buffer.size() - stream.avail_out);
        if (out.size() > max_bytes)
            throw std::runtime_error(fmt::format("larger than {} bytes when decompressed", max_bytes));
        if (status == Z_STREAM_END) {
            if (stream.avail_in == 0 && consumed == packed.size()) return out;
            inflateReset(&stream); // a gzip file may hold several members
        } else if (status == Z_BUF_ERROR && stream.avail_in == 0 && consumed == packed.size()) {
            throw std::runtime_error("truncated gzip data");
        } else if (status != Z_OK && status != Z_BUF_ERROR) {
            throw std::runtime_error("corrupt gzip data");
        }
    }
}

} // namespace

std::string read_file(const std::filesystem::path& path, std::size_t max_bytes) {
    std::error_code error;
    auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) throw std::runtime_error("no such file");
    if (std::filesystem::is_directory(status)) throw std::runtime_error("is a directory, not a file");
    // Some, such as /dev/zero, have no end.
    if (std::filesystem::is_character_file(status) || std::filesystem::is_block_file(status))
        throw std::runtime_error("is a device, not a file");
    std::string bytes = read_plain(path, max_bytes);
    bool gzipped = bytes.size() >= 2 && bytes[0] == '\x1f' && bytes[1] == '\x8b';
    return gzipped ? decompress(bytes, max_bytes) : bytes;
}

std::filesystem::path real_path(const std::filesystem::path& path) {
    std::error_code error;
    // What is not there yet would stay relative.
    const std::filesystem::path absolute = std::filesystem::absolute(path, error);
    if (error) return path;
    std::filesystem::path real = std::filesystem::weakly_canonical(absolute, error);
    return error ? path : real;
}

bool is_stream(const std::filesystem::path& path) {
    std::error_code unknown;
    // /dev/stdout may lead to a file that others are writing to.
    if (path.parent_path() == "/dev" && std::filesystem::is_symlink(path, unknown)) return true;
    const auto status = std::filesystem::status(path, unknown);
    return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
           !std::filesystem::is_directory(status);
}

void write_atomically(const std::filesystem::path& named,
                      const std::function<void(const std::filesystem::path&)>& write) {
    if (is_stream(named)) return write(named);
    std::error_code no_link;
    const std::filesystem::path target =
        std::filesystem::is_symlink(named, no_link) ? real_path(named) : named;
    // Same folder, same suffix (libraries choose the format by it), a name no other process takes.
    std::filesystem::path temporary = target;
    temporary.replace_filename(
        fmt::format(".{}.{}.tmp{}", target.stem().string(), ::getpid(), target.extension().string()));
    try {
        write(temporary);
        std::filesystem::rename(temporary, target);
    } catch (...) {
        std::error_code ignored;
        std::filesystem::remove(temporary, ignored);
        throw;
    }
}

void write_file(const std::filesystem::path& target, std::string_view bytes) {
    write_atomically(target, [&](const std::filesystem::path& temporary) {
        std::ofstream out(temporary, std::ios::binary);
        out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        out.close();
        if (!out)
            throw std::runtime_error(
                fmt::format("cannot write {}: {}", target.string(), std::generic_category().message(errno)));
    });
}

} // namespace alhazen
