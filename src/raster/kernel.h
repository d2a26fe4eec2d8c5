/// What the coverage kernels share with the rest: plain data and function pointers only, since each kernel is
/// one text compiled for several instruction sets (see accel/wide/kernel.h for why its files include nothing
/// else).
///
/// Coordinates are those of a viewport: pixels from its top left corner, y downwards. Nearness is a number
/// that grows towards the eye and is linear over the film, for every triangle.
#pragma once

#include <cstdint>

namespace alhazen {

constexpr std::int32_t raster_subpixel_bits = 12;
/// Places a pixel on which corners and samples may lie, per axis.
constexpr std::int32_t raster_subpixels = 1 << raster_subpixel_bits;
constexpr std::int32_t raster_block = 8;                           ///< pixels on a side of a block
constexpr std::int32_t raster_tile = 32;                           ///< pixels on a side of a tile
constexpr std::int32_t raster_blocks = raster_tile / raster_block; ///< blocks on a side of a tile
constexpr std::int32_t raster_block_pixels = raster_block * raster_block;
constexpr std::int32_t raster_max_samples = 16; ///< a pixel
/// In place of a fragment's number.
constexpr std::uint32_t raster_nothing = 0xffffffffu;

/// A triangle on the film. Its three edge functions a x + b y + c, x and y in subpixels, are not negative at
/// the samples that are inside; c counts the top-left rule in.
struct RasterTriangle {
    std::int32_t a[3], b[3];
    std::uint32_t draw;      ///< which shape it is of
    std::uint32_t primitive; ///< and which primitive of that
    std::int64_t c[3];
    double q0, qx, qy;           ///< nearness at the viewport's corner, and its growth over a pixel
    float q_min, q_max;          ///< nearness stays within
    std::int16_t x0, y0, x1, y1; ///< no pixels outside x0 <= x < x1, y0 <= y < y1 are touched
};

/// Where tiles are drawn: for each block from the top left, for each sample, a block's pixels row by row.
struct RasterTarget {
    std::int32_t x, y; ///< the tile's first pixel
    std::uint32_t samples;
    std::int32_t sample_x[raster_max_samples], sample_y[raster_max_samples]; ///< in the pixel, subpixels
    float* nearness;
    std::uint32_t* fragment;
    /// What is not nearer than this changes nothing in the block: the hierarchical part of the depth buffer.
    float block_nearness[raster_blocks * raster_blocks];
    std::uint32_t block_changes[raster_blocks * raster_blocks]; ///< since block_nearness was made
};

/// Triangles of which list[i] are to be drawn, as fragments with numbers first_fragment + list[i].
struct RasterBatch {
    const RasterTriangle* triangles;
    const std::uint32_t* list;
    std::uint32_t count;
    std::uint32_t first_fragment;
    void* owner;
    /// Whether the surface is there at a sample of a pixel, in viewport coordinates; nullptr: everywhere.
    bool (*accept)(void* owner, std::uint32_t fragment, std::int32_t x, std::int32_t y, std::uint32_t sample);
};

struct RasterKernel {
    const char* name;
    bool (*is_supported)();
    void (*draw)(RasterTarget&, const RasterBatch&);
};

/// One a file; nullptr where the compiler knows no such instructions.
const RasterKernel* raster_kernel_plain();
const RasterKernel* raster_kernel_avx2();

} // namespace alhazen
