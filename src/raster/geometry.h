/// The rasteriser's first half: every primitive that may be seen, taken onto the film, set up and sorted into
/// tiles.
#pragma once

#include <span>
#include <vector>

#include "raster/draws.h"
#include "raster/setup.h"

namespace alhazen {

/// A primitive that is no triangle: it is ray cast at the samples of the pixels that it may cover.
struct RasterCast {
    std::uint32_t draw = 0, primitive = 0;
    float q_max = infinity; ///< it is nowhere nearer
    std::int16_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// Which things of a list touch which tile.
class TileBins {
  public:
    struct Entry {
        std::uint32_t tile, thing;
    };
    /// The things of one tile: begin ... end - 1 of things().
    struct Run {
        std::uint32_t tile, begin, end;
        float q_max; ///< none is nearer
    };
    /// Keeps the order of the entries in each tile. counters: as many zeros as there are tiles; they are
    /// zeros again afterwards. nearest(thing): nearer than that no part of it is.
    template <class Nearest>
    void sort(const std::vector<Entry>& entries, std::vector<std::uint32_t>& counters,
              const Nearest& nearest);
    /// One for each tile that has things.
    const std::vector<Run>& runs() const { return runs_; }
    const std::vector<std::uint32_t>& things() const { return things_; }

  private:
    std::vector<Run> runs_;
    std::vector<std::uint32_t> things_;
};

/// Some primitives that are next to each other, of one shape or several small ones.
struct RasterChunk {
    struct Run {
        std::uint32_t draw, first, count;
    };
    std::vector<Run> runs;
    std::vector<RasterTriangle> triangles;
    std::vector<RasterCorner> corners; ///< of the triangles
    std::vector<RasterPlane> planes;   ///< of triangles that were clipped
    std::vector<RasterCast> casts;
    TileBins solid_bins, cutout_bins, cast_bins;
};

/// A viewport's tiles, row by row.
struct TileGrid {
    int across = 0, down = 0;

    explicit TileGrid(Vec2i size)
        : across((size.x + raster_tile - 1) / raster_tile), down((size.y + raster_tile - 1) / raster_tile) {}
    std::size_t count() const { return static_cast<std::size_t>(across) * static_cast<std::size_t>(down); }
};

/// For each tile, the chunks that have things in it, in their order.
class TileIndex {
  public:
    struct Entry {
        std::uint32_t chunk, begin, end; ///< of the things of the chunk's bins
        float q_max;                     ///< none of these is nearer
    };
    TileIndex(const std::vector<RasterChunk>& chunks, TileBins RasterChunk::*bins, std::size_t tiles);
    std::span<const Entry> of(std::size_t tile) const {
        return std::span(entries_).subspan(starts_[tile], starts_[tile + 1] - starts_[tile]);
    }

  private:
    std::vector<std::uint32_t> starts_;
    std::vector<Entry> entries_;
};

/// The chunks of all draws, in their order. near_depth: nothing nearer than that is seen.
struct RasterView {
    Rect2i part; ///< pixels of the viewport that are wanted
    bool single_sample = true;
    bool is_perspective = true;
    double near_depth = 0;
};
std::vector<RasterChunk> make_chunks(const std::vector<Draw>& draws, const RasterView& view,
                                     const RasterKernel& kernel);

/// Everything that tiles are drawn from.
struct SortedGeometry {
    std::vector<Draw> draws;
    std::vector<RasterChunk> chunks;
    TileIndex solid, cutouts, casts;

    SortedGeometry(std::vector<Draw> draws_, const RasterView& view, const RasterKernel& kernel)
        : draws(std::move(draws_)), chunks(make_chunks(draws, view, kernel)),
          solid(chunks, &RasterChunk::solid_bins, TileGrid(view.part.hi).count()),
          cutouts(chunks, &RasterChunk::cutout_bins, TileGrid(view.part.hi).count()),
          casts(chunks, &RasterChunk::cast_bins, TileGrid(view.part.hi).count()) {}
    SortedGeometry(const SortedGeometry&) = delete;
    SortedGeometry& operator=(const SortedGeometry&) = delete;
};

} // namespace alhazen
