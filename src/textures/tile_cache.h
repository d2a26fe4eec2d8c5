/// Texels in tiles, of which those that were looked up lately are in memory (Pharr, Kolb, Gershbein and
/// Hanrahan 1997, "Rendering complex scenes with memory-coherent ray tracing", section 3.1). All of them lie
/// in a temporary file, as lookups want them, since PNG and JPEG files cannot be read in part and fitting
/// spectra takes far longer than reading a tile.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include <oneapi/tbb/enumerable_thread_specific.h>

#include "base/temporary_file.h"
#include "textures/texture_memory.h"

namespace alhazen {

/// May be used from several threads. A tile is known by where it begins in the file.
class TileCache {
    struct Tile {
        std::uint64_t offset = 0;
        std::vector<std::byte> bytes;
    };
    using TilePointer = std::shared_ptr<const Tile>;

  public:
    /// Texels a tile is wide and high; those at the right and lower border may be smaller.
    static constexpr int side = 32;

    /// A thread's own list of the tiles it looked at last, which it reads without asking anybody.
    class Recent {
      public:
        explicit Recent(TileCache& cache) : cache_(cache) {}

        /// The bytes of a tile; valid until this thread asks for another one.
        const std::byte* tile(std::uint64_t offset, std::size_t bytes) {
            TilePointer& slot = slots_[(offset * 0x9e3779b97f4a7c15u) >> 58];
            if (!slot || slot->offset != offset) {
                slot.reset(); // may be dropped now
                slot = cache_.get(offset, bytes);
            }
            return slot->bytes.data();
        }

      private:
        TileCache& cache_;
        std::array<TilePointer, 64> slots_;
    };

    /// limit: bytes of tiles in memory. Tiles that threads look at stay, whatever the limit.
    explicit TileCache(std::size_t limit) : limit_(limit) {}
    ~TileCache() = default;
    TileCache(const TileCache&) = delete;
    TileCache& operator=(const TileCache&) = delete;

    TemporaryFile& file() { return file_; }
    /// The calling thread's.
    Recent& recent() { return recent_.local(); }
    TextureMemory memory() const;
    std::size_t bytes() const { return bytes_; }
    /// Throws std::runtime_error if a tile could not be read; in its place were zeros.
    void throw_if_failed() const;

  private:
    // A part of the table, so that threads seldom wait for each other.
    struct Shard {
        std::mutex mutex;
        std::list<TilePointer> tiles; ///< the one that was asked for last first
        std::unordered_map<std::uint64_t, std::list<TilePointer>::iterator> places;
    };

    TilePointer get(std::uint64_t offset, std::size_t bytes);
    TilePointer find(Shard& shard, std::uint64_t offset);
    TilePointer insert(Shard& shard, TilePointer tile);
    TilePointer read(std::uint64_t offset, std::size_t bytes);
    void make_room();
    bool drop_oldest(Shard& shard);

    const std::size_t limit_;
    TemporaryFile file_;
    std::array<Shard, 64> shards_;
    std::atomic<std::size_t> bytes_ = 0, peak_ = 0, next_shard_ = 0;
    std::atomic<std::uint64_t> made_ = 0, dropped_ = 0;
    mutable std::mutex mutex_;
    tbb::enumerable_thread_specific<Recent> recent_{[this] { return Recent(*this); }};
    std::string failure_;
};

} // namespace alhazen
