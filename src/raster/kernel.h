/// What the rasteriser's kernels share with the rest: plain data and function pointers only, since each
/// kernel is one text compiled for several instruction sets (see accel/wide/kernel.h for why its files
/// include nothing else).
///
/// Coordinates are those of a viewport: pixels from its top left corner, y downwards. Nearness is a number
/// that grows towards the eye and is linear over the film, for every triangle.
#pragma once

#include <cstddef>
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

/// Corners may lie this far outside of the viewport (pixels): raster_guard_low <= x, y <= raster_guard_high.
/// What reaches farther must be clipped.
constexpr double raster_guard_low = -6144, raster_guard_high = 10240;

/// A corner of triangles: where it is, how near, and its place rounded to subpixels.
struct RasterCorner {
    double x, y, q;
    std::int32_t fixed_x, fixed_y;
};

/// How nearness grows over the film.
struct RasterPlane {
    double q0, qx, qy; ///< at the viewport's corner, and over a pixel
};

/// A triangle on the film, as little of it as is needed to see that it is hidden.
struct RasterTriangle {
    static constexpr std::uint16_t no_plane = 0xffff, to_clip = 0xfffe;
    std::uint16_t corner[3];     ///< in its batch's list
    std::uint16_t plane;         ///< in its batch's list, or no_plane for the one through its corners;
                                 ///< to_clip: it must be clipped first
    std::uint32_t draw;          ///< which shape it is of
    std::uint32_t primitive;     ///< and which primitive of that
    float q_max;                 ///< it is nowhere nearer
    std::int16_t x0, y0, x1, y1; ///< no pixels outside x0 <= x < x1, y0 <= y < y1 are touched
};

/// Where tiles are drawn: for each block from the top left, for each sample, a block's pixels row by row.
struct RasterTarget {
    std::int32_t x, y; ///< the tile's first pixel
    std::uint32_t samples;
    std::int32_t sample_x[raster_max_samples], sample_y[raster_max_samples]; ///< in the pixel, subpixels
    float* nearness;
    std::uint32_t* fragment;
    /// What is farther than this changes nothing in the block: the hierarchical part of the depth buffer.
    float block_nearness[raster_blocks * raster_blocks];
    std::uint32_t block_changes[raster_blocks * raster_blocks]; ///< triangles since block_nearness was made
};

/// Triangles of which list[i] are to be drawn, as fragments with numbers first_fragment + list[i]. What is
/// nearest shows; of what is equally near, the lowest number: so the order of batches does not matter.
struct RasterBatch {
    const RasterTriangle* triangles;
    const RasterCorner* corners;
    const RasterPlane* planes;
    const std::uint32_t* list;
    std::uint32_t count;
    std::uint32_t first_fragment;
    float q_max; ///< none is nearer
    void* owner;
    /// Whether the surface is there at a sample of a pixel, in viewport coordinates; nullptr: everywhere.
    bool (*accept)(void* owner, std::uint32_t fragment, std::int32_t x, std::int32_t y, std::uint32_t sample);
};

/// Sides of the wanted part of the viewport (and of what can be drawn at all) that a point is beyond.
enum RasterSide : std::uint8_t {
    raster_left = 1,
    raster_right = 2,
    raster_above = 4,
    raster_below = 8,
    raster_behind = 16,       ///< nearer than near_depth, or not a number; the corner is then unspecified
    raster_beyond_guard = 32, ///< the corner is then at the guard band's border
};

/// From space to the viewport.
struct RasterProjection {
    double rows[4][4]; ///< x w, y w, depth and w
    double left, right, above, below;
    double near_depth; ///< nothing nearer is seen
    bool is_perspective;
};

/// The part of the viewport that is wanted.
struct RasterPart {
    std::int32_t x0, y0, x1, y1; ///< pixels x0 <= x < x1, y0 <= y < y1
    bool single_sample;          ///< one sample a pixel, in the middle; or several, which may be anywhere
};

/// The rays through the film's places: see FilmRays.
struct RasterRays {
    float start[3], ahead[3], across[3], down[3];
    bool is_perspective;
};

/// Matte points waiting to be lit together.
struct alignas(64) RasterPoints {
    static constexpr std::uint32_t capacity = 256, lanes = 16;
    using Array = float[capacity];

    std::uint32_t count = 0;            ///< arrays must hold numbers up to the next multiple of lanes
    alignas(64) Array film_x, film_y;   ///< where they are on the film
    alignas(64) Array nearness;         ///< and how near
    alignas(64) Array px, py, pz;       ///< where they are
    alignas(64) Array nx, ny, nz;       ///< shading normals towards the eye
    alignas(64) Array gx, gy, gz;       ///< geometric normals
    alignas(64) Array red, green, blue; ///< the BSDF; after lighting, the light sent to the eye
};

/// A light by its numbers: see LocalLight.
struct RasterLight {
    float p[3], normal[3], area;
    bool is_distant, is_flat, is_two_sided;
};

struct RasterKernel {
    const char* name;
    bool (*is_supported)();
    void (*draw)(RasterTarget&, const RasterBatch&);
    /// Takes count points (x, y, z each) onto the film; sides: of RasterSide.
    void (*project)(const RasterProjection&, const float* points, std::size_t count, RasterCorner* corners,
                    std::uint8_t* sides);
    /// Which of count triangles may cover a sample, in their order; how many these are. numbers: of the
    /// corners, three for each; sides: of the corners. A kept triangle's primitive is its number among the
    /// count, its draw is left open; there must be room for all, and one more.
    std::size_t (*cull)(const RasterPart&, const RasterCorner* corners, const std::uint8_t* sides,
                        const std::uint16_t* numbers, std::size_t count, RasterTriangle* kept);
    /// Takes points from the film to where they are, and turns their normals to the eye.
    void (*place)(const RasterRays&, RasterPoints&);
    /// What of a light arrives at each point, times the cosine and before its colour; there must be room for
    /// RasterPoints::capacity, 64-byte aligned.
    void (*light)(const RasterLight&, const RasterPoints&, float* part);
};

/// One a file; nullptr where the compiler knows no such instructions.
const RasterKernel* raster_kernel_plain();
const RasterKernel* raster_kernel_avx2();
const RasterKernel* raster_kernel_avx512();

} // namespace alhazen
