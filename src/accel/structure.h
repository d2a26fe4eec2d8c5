/// The finished acceleration structure, whatever its builder, layout and walk: what a scene's objects and the
/// measurements hold.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "accel/build/tree.h"
#include "accel/leaf_store.h"

namespace alhazen {

/// What one or more rays did on their way; sums, but for the stack.
struct WalkCounts {
    std::uint64_t nodes = 0;     ///< inner nodes whose children's boxes were tested
    std::uint64_t leaves = 0;    ///< leaves whose primitives were tested
    std::uint64_t restarts = 0;  ///< times a walk without a full stack began again at the root
    std::uint32_t max_stack = 0; ///< entries on the stack at most, of any ray
};

/// The layout in memory.
struct LayoutStats {
    std::size_t nodes = 0; ///< of the layout's own width
    int depth = 0;         ///< edges from the root to the deepest leaf
    std::size_t bytes = 0; ///< all the structure holds, primitives' copies included
};

/// Finds primitives. Immutable; may be asked from any thread. Rays that are not finite, have no direction or
/// an empty interval hit nothing.
class Structure {
  public:
    virtual ~Structure() = default;

    /// The box around all that can be hit; empty when there is nothing.
    virtual const Bounds3& bounds() const = 0;
    virtual LayoutStats stats() const = 0;

    /// The nearest hit with 0 < t < ray.tmax, and of those at the same t the primitive with the lowest
    /// number; false (and hit untouched) when there is none. hit must be as constructed. ray_index is for
    /// tests.
    virtual bool closest(const Ray& ray, Intersection& hit, PrimitiveTests& tests,
                         std::uint32_t ray_index = 0) const = 0;
    /// Whether there is any hit with 0 < t < ray.tmax.
    virtual bool any(const Ray& ray, PrimitiveTests& tests, std::uint32_t ray_index = 0) const = 0;

    /// The same for many rays at once, faster where the walk knows how; hits as constructed, one a ray.
    virtual void closest(std::span<const Ray> rays, std::span<Intersection> hits,
                         PrimitiveTests& tests) const;
    /// blocked: one a ray, set to 0 or 1.
    virtual void any(std::span<const Ray> rays, std::span<std::uint8_t> blocked, PrimitiveTests& tests) const;

    /// Walks as closest or any do, ray by ray, and adds what was visited to counts. True when there is a hit.
    virtual bool count(Query query, const Ray& ray, PrimitiveTests& tests, WalkCounts& counts) const = 0;
};

} // namespace alhazen
