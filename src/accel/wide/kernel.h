/// What the production structure's kernels share with the rest: plain data and function pointers only.
///
/// Each kernel is one text compiled several times, for several instruction sets, and chosen at run time. Its
/// files must not include headers with inline functions: the linker keeps one copy of those, and it could be
/// the one a processor does not understand. So a kernel tests boxes, and sorts out which triangles of a leaf
/// may be hit; the exact tests, and all that is done once a ray, are called through WideQuery, in code
/// compiled for every processor.
#pragma once

#include <cstddef>
#include <cstdint>

namespace alhazen {

/// Eight children, structure of arrays. A child without a primitive has an inverted box.
struct alignas(64) WideNode {
    float planes[3][2][8];  ///< axis; lower, upper; child
    std::uint32_t child[8]; ///< references
    std::uint8_t order[4]
                      [3]; ///< for four octants of directions: 8 numbers of 3 bits, the farthest child first
    std::uint8_t unused[20];
};
static_assert(sizeof(WideNode) == 256);

/// References: a byte's address, a multiple of 32, and what is there in the five low bits, so that nothing
/// need be taken apart to come to a node. Nodes have no bit set.
///
/// A leaf of n plain triangles: nine arrays of n floats (corner a's x, y, z, then b's, then c's), then n
/// primitive numbers. Any other leaf begins with a word: how many primitives, and wide_filtered when they are
/// triangles, which follow as above; wide_filtered stands in the numbers of those whose hits must be
/// accepted. Without that bit only primitive numbers follow.
enum WideReference : std::uint32_t {
    wide_leaf = 1,
    wide_count_shift = 1,        ///< three bits of a leaf of plain triangles: how many - 1
    wide_other = 16,             ///< a leaf of other primitives
    wide_address = 0xffffffe0u,  ///< mask
    wide_done = 0x1f,            ///< at the bottom of every stack; nothing is there
    wide_unit = 32,              ///< what addresses are multiples of, bytes
    wide_filtered = 0x80000000u, ///< in the first word of other leaves, and in primitive numbers
};
enum : std::uint32_t {
    wide_stack = 256, ///< entries; layouts see to it that this is enough
};

/// One ray on its way, with all that is computed once a ray.
struct alignas(64) WideSlot {
    float enter_scale[4], enter_offset[4], leave_scale[4], leave_offset[4]; ///< see BoxRay
    std::uint32_t near_plane[4]; ///< where in a node the planes are through which the ray enters, bytes
    float tmax;                  ///< where the search ends by now
    std::uint32_t height;        ///< of the stack
    std::uint32_t next;          ///< reference to be visited
    std::uint32_t order;         ///< where in a node the octant's order is, bytes
    std::uint32_t is_reversed;   ///< the order is to be read from its end
    std::uint32_t ray;           ///< number in the batch
    float t, u, v;               ///< nearest hit so far
    std::uint32_t primitive;     ///< no_primitive: none
    float origin[4];             ///< in the sheared axes
    float shear[4];              ///< see RayShear: x, y, z
    std::uint32_t axis[4];       ///< which axis is the sheared x, y, z
    std::uint64_t nodes, leaves; ///< visited, where they are counted
    std::uint32_t highest;       ///< of the stack, where it is counted
};

/// What a ray has still to visit: references, and where it enters what they refer to.
struct WideStack {
    std::uint32_t reference[wide_stack];
    float entry[wide_stack];
};

/// A ray: origin, direction, end, and time, which kernels do not read.
struct WideRay {
    float o[3], d[3], tmax, time;
};

/// A hit, as Intersection holds it.
struct WideHit {
    float t, u, v;
    std::uint32_t primitive, instance;
};

/// A question about some rays.
struct WideQuery {
    const char* base = nullptr; ///< of addresses
    std::uint32_t root = 0;
    float extent = 0; ///< the largest coordinate of any box
    const WideRay* rays = nullptr;
    std::uint32_t count = 0;
    WideHit* hits = nullptr;         ///< closest: one a ray, written where there is a hit
    std::uint8_t* blocked = nullptr; ///< any: one a ray, set to 1 where there is a hit
    void* owner = nullptr;
    /// Tests the leaf's primitives whose bits are set; true when the slot's hit and tmax have changed.
    bool (*test)(void* owner, WideSlot& slot, std::uint32_t reference, std::uint32_t candidates) = nullptr;
    /// Where visits are counted: takes the slot's.
    void (*count_visits)(void* owner, const WideSlot& slot) = nullptr;
};

/// The kernels for one instruction set.
struct WideKernels {
    const char* name;
    bool (*is_supported)();
    void (*closest)(const WideQuery&); ///< many rays, interleaved
    void (*any)(const WideQuery&);
    void (*closest_one)(const WideQuery&); ///< the same, ray after ray
    void (*any_one)(const WideQuery&);
    void (*closest_counted)(const WideQuery&); ///< ray after ray, filling in what is counted
    void (*any_counted)(const WideQuery&);
};

/// One a file; nullptr where the compiler knows no such instructions.
const WideKernels* wide_kernels_plain();
const WideKernels* wide_kernels_sse42();
const WideKernels* wide_kernels_avx2();
const WideKernels* wide_kernels_avx512();

} // namespace alhazen
