/// What the kernels that follow bundles of rays share with the rest: plain data and function pointers only,
/// since each is one text compiled for several instruction sets (see accel/wide/kernel.h for why its files
/// include nothing else).
#pragma once

#include <cstddef>
#include <cstdint>

namespace alhazen {

/// Rays in a bundle.
constexpr std::uint32_t bundle_lanes = 8;
/// Numbers of a Spectrum.
constexpr std::uint32_t bundle_colors = 4;

/// With more an acceleration structure is sooner done; sets of them are bits of one number.
constexpr std::uint32_t most_bundle_balls = 64;
/// How far off single precision finds the distance between a line and a ball's centre, relative to their
/// coordinates: some roundings, with much room.
constexpr float bundle_rough = 0x1p-19f;

/// A ball, and its surface by Phong and Whitted.
struct BundleBall {
    double x, y, z, radius, radius_squared;
    float near_x, near_y, near_z; ///< the centre, rounded
    float reach; ///< how near single precision may find rays that meet it, but for their origins' part
    std::uint32_t primitive; ///< its number: of balls at the same distance the lowest is seen
    float side;              ///< 1, or -1 where its normal points inward
    float mirror, refract, eta, shininess;
    float ambient[bundle_colors]; ///< times the scene's ambient light
    float diffuse[bundle_colors], specular[bundle_colors];
};

/// A light that shines alike from a point.
struct BundleLight {
    float x, y, z;
    float intensity[bundle_colors];
    bool fades;                    ///< with the square of the distance
    const std::uint64_t* blockers; ///< for each ball: which ones may hide this light from its surface
};

/// All there is.
struct BundleScene {
    const BundleBall* balls; ///< by their size, so that large ones behind small ones need no closer look
    std::uint64_t all_balls; ///< a bit each
    const BundleLight* lights;
    std::uint32_t light_count;
    int maxdepth;
    bool shadows;
};

/// Camera rays, of which the first count are meant; structure of arrays, axis by axis.
struct alignas(32) BundleRays {
    float o[3][bundle_lanes], d[3][bundle_lanes];
    std::uint32_t count;
};

struct alignas(32) BundleRadiance {
    float color[bundle_colors][bundle_lanes];
};

struct BundleCounts {
    std::uint64_t bounce = 0, shadow = 0;
};

struct BundleKernel {
    const char* name; ///< "plain", "avx2" or "avx512"
    bool (*is_supported)();
    void (*trace)(const BundleScene& scene, const BundleRays& rays, BundleRadiance& radiance,
                  BundleCounts& counts);
};

const BundleKernel* bundle_kernel_plain();
/// nullptr where the compiler was not told to make it.
const BundleKernel* bundle_kernel_avx2();
const BundleKernel* bundle_kernel_avx512();

} // namespace alhazen
