/// What is seen at each sample of a picture: the rasteriser as a whole.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "cameras/camera.h"
#include "raster/geometry.h"

namespace alhazen {

/// A primitive of a shape, as seen at a sample.
struct Fragment {
    const PlacedSurface* surface;
    std::uint32_t primitive;
};

/// A finished tile, as long as it is shown.
class DrawnTile {
  public:
    static constexpr std::uint32_t nothing = raster_nothing;

    const Rect2i& pixels() const { return pixels_; } ///< of the film
    std::uint32_t samples() const { return target_.samples; }
    /// Number of what is seen at a sample of a pixel of the tile, or nothing. Equal numbers are equal pieces
    /// of surface.
    std::uint32_t number(Vec2i pixel, std::uint32_t sample) const {
        return target_.fragment[place(pixel, sample)];
    }
    /// How near it is: 1 / depth for perspective projections, -depth for others.
    float nearness(Vec2i pixel, std::uint32_t sample) const { return target_.nearness[place(pixel, sample)]; }
    /// The same of a pixel and those right of it in its block, sample by sample: of sample s of the i-th at
    /// at(i, s).
    struct Row {
        const std::uint32_t* numbers;
        const float* nearness;
        static std::size_t at(int i, std::uint32_t sample) {
            return static_cast<std::size_t>(i) + std::size_t{sample} * raster_block_pixels;
        }
    };
    Row row(Vec2i pixel) const {
        const std::size_t first = place(pixel, 0);
        return {target_.fragment + first, target_.nearness + first};
    }
    /// Of a number that is not nothing.
    Fragment fragment(std::uint32_t number) const;
    /// Where in each pixel a sample is, 0 ... 1.
    Vec2 sample_place(std::uint32_t sample) const;

  private:
    friend class TileDrawer;
    std::size_t place(Vec2i pixel, std::uint32_t sample) const {
        const int x = pixel.x - corner_.x, y = pixel.y - corner_.y;
        const int block = (y / raster_block) * raster_blocks + x / raster_block;
        return (static_cast<std::size_t>(block) * target_.samples + sample) * raster_block_pixels +
               static_cast<std::size_t>((y % raster_block) * raster_block + x % raster_block);
    }

    Rect2i pixels_;
    Vec2i corner_; ///< of the whole tile
    RasterTarget target_{};
    const std::vector<Draw>* draws_ = nullptr;
    const std::vector<RasterChunk>* chunks_ = nullptr;
    /// What rays met in whole objects.
    struct Met {
        PlacedSurface surface;
        std::uint32_t primitive;
    };
    std::vector<Met> met_;
};

/// Rasterises the scene for a camera that has a projection.
class Rasterizer {
  public:
    /// How many samples a pixel may have: 1, 4, 8 or 16.
    static bool is_sample_count(int samples) {
        return samples == 1 || samples == 4 || samples == 8 || samples == 16;
    }

    Rasterizer(const Scene& scene, const Camera& camera, int samples)
        : scene_(scene), camera_(camera), projection_(*camera.projection()), samples_(samples) {}

    /// Which of the kernels draws; the best by default. Does not change what is drawn.
    void set_kernel(const RasterKernel& kernel) { kernel_ = &kernel; }

    /// Draws all but this shape of the scene itself.
    void leave_out(const PlacedShape* shape) { left_out_ = shape; }

    using Show = std::function<void(const DrawnTile&)>;
    /// Draws these pixels of the film and shows each tile, several at a time on several threads.
    void run(const Rect2i& pixels, const Show& show) const;

  private:
    void run_viewport(Vec2i origin, const Rect2i& part, const Show& show) const;

    const Scene& scene_;
    const Camera& camera_;
    Projection projection_;
    int samples_;
    const RasterKernel* kernel_ = nullptr;
    const PlacedShape* left_out_ = nullptr;
};

} // namespace alhazen
