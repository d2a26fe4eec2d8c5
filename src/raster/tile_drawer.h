/// Draws one tile: triangles through the kernel, other shapes by casting rays at the samples they may cover.
#pragma once

#include "raster/rasterizer.h"

namespace alhazen {

/// Reused from tile to tile by one thread at a time.
class TileDrawer {
  public:
    TileDrawer(const Camera& camera, const Projection& projection, const SortedGeometry& geometry,
               const RasterKernel& kernel, int samples);

    TileDrawer(const TileDrawer&) = delete;
    TileDrawer& operator=(const TileDrawer&) = delete;

    /// origin: of the viewport, on the film; part: what is wanted of the viewport. The tile is good until the
    /// next call.
    const DrawnTile& draw(Vec2i origin, const Rect2i& part, int tile_x, int tile_y);

  private:
    void clear(Vec2i origin, const Rect2i& part, int tile_x, int tile_y);
    void draw_triangles(std::size_t tile);
    void draw_casts(std::size_t tile);
    /// A cast in the tile, and its number.
    struct NumberedCast {
        const RasterCast* cast;
        std::uint32_t number;
    };
    void draw_cast(const NumberedCast& cast);
    void cast_block(const NumberedCast& cast, int bx, int by);
    void cast_sample(const NumberedCast& cast, int x, int y, std::uint32_t sample, std::size_t place);
    bool cast_shape(const RasterCast& cast, const Ray& ray, float& t) const;
    bool cast_object(const RasterCast& cast, const Ray& ray, float& t, std::uint32_t& number);
    bool accept(std::uint32_t number, int x, int y, std::uint32_t sample) const;
    std::optional<Ray> ray_at(int x, int y, std::uint32_t sample) const;
    float nearness_of(const Ray& ray, float t) const;
    float distance_of(const Ray& ray, float nearness) const;

    const Camera& camera_;
    const Projection& projection_;
    const SortedGeometry& geometry_;
    const std::vector<Draw>& draws_;
    const RasterKernel& kernel_;
    std::vector<float> nearness_;
    std::vector<std::uint32_t> fragment_;
    std::vector<TileIndex::Entry> runs_;
    std::vector<NumberedCast> casts_;
    Vec2i origin_; ///< of the viewport, on the film
    DrawnTile tile_;
};

/// A fragment's number says which chunk it is in, and where there, whether it is a triangle or was cast; or
/// where in the tile's list of what rays met in whole objects.
struct FragmentNumber {
    static constexpr std::uint32_t cast_bit = 0x80000000u, met_bits = 0xc0000000u;
    static constexpr int local_bits = 14;
    static std::uint32_t of(std::size_t chunk, std::uint32_t local, bool is_cast) {
        return (static_cast<std::uint32_t>(chunk) << local_bits) | local | (is_cast ? cast_bit : 0);
    }
    static std::uint32_t of_met(std::size_t index) { return static_cast<std::uint32_t>(index) | met_bits; }
    static bool is_met(std::uint32_t number) { return (number & met_bits) == met_bits; }
    static std::size_t index(std::uint32_t number) { return number & ~met_bits; }
    static std::size_t chunk(std::uint32_t number) { return (number & ~met_bits) >> local_bits; }
    static std::uint32_t local(std::uint32_t number) { return number & ((1u << local_bits) - 1); }
    static bool is_cast(std::uint32_t number) { return (number & cast_bit) != 0; }
};

} // namespace alhazen
