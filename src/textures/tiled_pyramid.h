/// A pyramid whose texels lie in a TileCache. Lookups give the same bits as those of Pyramid.
#pragma once

#include <cstring>

#include "image/make_pyramid.h"
#include "textures/tile_cache.h"

namespace alhazen {

template <class T>
class TiledPyramid : public PyramidLookups<TiledPyramid<T>, T> {
    static_assert(std::is_trivially_copyable_v<T>);

  public:
    /// A level as one thread reads it.
    struct Level {
        Vec2i size;
        std::uint64_t offset; ///< of its first tile in the file
        TileCache::Recent* recent;

        T at(Vec2i p) const {
            const Vec2i corner{p.x - p.x % TileCache::side, p.y - p.y % TileCache::side};
            const auto width = static_cast<std::size_t>(std::min(TileCache::side, size.x - corner.x));
            const auto height = static_cast<std::size_t>(std::min(TileCache::side, size.y - corner.y));
            const std::size_t before = static_cast<std::size_t>(corner.y) * static_cast<std::size_t>(size.x) +
                                       static_cast<std::size_t>(corner.x) * height;
            const std::byte* tile = recent->tile(offset + before * sizeof(T), width * height * sizeof(T));
            const std::size_t in_tile =
                static_cast<std::size_t>(p.y - corner.y) * width + static_cast<std::size_t>(p.x - corner.x);
            T texel;
            std::memcpy(&texel, tile + in_tile * sizeof(T), sizeof(T));
            return texel;
        }
    };

    /// Throws std::runtime_error when there is no room for the file.
    TiledPyramid(Image image, WrapMode mode, const FillRows<T>& fill, std::shared_ptr<TileCache> tiles)
        : tiles_(std::move(tiles)), mode_(mode) {
        for_each_level(std::move(image), true, [&](const Image& level) { add(level, fill); });
    }

    int levels() const { return static_cast<int>(stored_.size()); }
    Vec2i size(int level = 0) const { return stored_[static_cast<std::size_t>(level)].size; }
    Level level(int i) const {
        const Stored& stored = stored_[static_cast<std::size_t>(i)];
        return {stored.size, stored.offset, &tiles_->recent()};
    }
    WrapMode wrap_mode() const { return mode_; }
    /// None of its own: the cache counts the tiles that are in memory.
    std::size_t bytes() const { return 0; }

  private:
    struct Stored {
        Vec2i size;
        std::uint64_t offset;
    };

    void add(const Image& image, const FillRows<T>& fill) {
        const auto width = static_cast<std::size_t>(image.width());
        const auto height = static_cast<std::size_t>(image.height());
        const Stored level{image.size(), tiles_->file().reserve(width * height * sizeof(T))};
        stored_.push_back(level);
        parallel_ranges(height, TileCache::side, [&](std::size_t first, std::size_t last) {
            std::vector<T> rows(width * (last - first));
            fill(image, static_cast<int>(first), static_cast<int>(last), rows);
            const std::vector<T> cut = in_tiles(rows, width);
            tiles_->file().write(level.offset + first * width * sizeof(T), std::as_bytes(std::span(cut)));
        });
    }

    // The texels of a row of tiles, one tile after the other.
    static std::vector<T> in_tiles(const std::vector<T>& rows, std::size_t width) {
        std::vector<T> out;
        out.reserve(rows.size());
        for (std::size_t x = 0; x < width; x += TileCache::side)
            for (std::size_t row = 0; row < rows.size(); row += width) {
                const T* first = rows.data() + row + x;
                out.insert(out.end(), first, first + std::min<std::size_t>(TileCache::side, width - x));
            }
        return out;
    }

    std::shared_ptr<TileCache> tiles_;
    std::vector<Stored> stored_;
    WrapMode mode_;
};

} // namespace alhazen
