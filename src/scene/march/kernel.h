/// What the kernels that march through a distance field share with the rest: plain data and function pointers
/// only, since each is one text compiled for several instruction sets (see accel/wide/kernel.h for why its
/// files include nothing else).
#pragma once

#include <cstddef>
#include <cstdint>

namespace alhazen {

/// Samples nearer than so many cells to a surface know its plane. What is in a sample's cell is nearer than
/// half of the cell's diagonal.
constexpr float march_near = 1;
/// Cells, from where a ray starts or comes into the field, within which it meets nothing: mostly it starts on
/// a surface, and nothing stands at the field's sides.
constexpr float march_free = 0.6f;

/// A sample of the field: its distance from the nearest triangle in eighths of a cell, rounded down, and, if
/// that is near, the triangle's plane: the distances around, to first order. Eight bits each: the distance,
/// two octahedral coordinates of the normal (Cigolle et al. 2014, "A Survey of Efficient Representations for
/// Independent Unit Vectors"), and the plane's height above the sample, along the normal whose three parts'
/// sizes add up to 1.
using MarchSample = std::uint32_t;
constexpr int march_normal_x = 8, march_normal_y = 16, march_height = 24; ///< the bits where they begin
constexpr std::uint32_t march_steps = 255;                                ///< of each
constexpr float march_steps_a_cell = 8;
constexpr float march_most_height = 1.275f; ///< cells; minus that is the least

/// Samples stand a cell apart, in bricks of 4 x 4 x 4. Bricks far from all triangles know no more than the
/// distance of their middle, so that the way through what is empty is short and needs little memory.
struct MarchField {
    const std::uint32_t* bricks;      ///< march_is_far and that distance, in eighths of a cell, or a number
    const MarchSample* samples;       ///< of the bricks with numbers, 64 each
    std::int32_t last[3];             ///< sample on each axis
    std::int32_t bricks_x, bricks_xy; ///< bricks in a row, in a layer
    float lo[3];                      ///< the first sample's place
    float cell;                       ///< the samples' distance
};
constexpr std::uint32_t march_is_far = 0x80000000u;

/// As Ray in base/ray.h is in memory.
constexpr std::uint32_t march_ray_size = 8;

struct MarchRays {
    const float* rays; ///< march_ray_size numbers each: origin, direction, tmax
    std::uint32_t count;
    float free_cells;      ///< before their tmax, where nothing is met
    float* t;              ///< where something is met; infinity: nothing
    std::uint32_t* sample; ///< its number, where something is met
};

struct MarchKernel {
    const char* name; ///< "plain", "avx2" or "avx512"
    bool (*is_supported)();
    void (*march)(const MarchField& field, const MarchRays& rays);
};

const MarchKernel* march_kernel_plain();
/// nullptr where the compiler was not told to make it.
const MarchKernel* march_kernel_avx2();
const MarchKernel* march_kernel_avx512();

} // namespace alhazen
