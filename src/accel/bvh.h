/// The acceleration structure that scenes use: a builder, a layout and a walk put together.
#pragma once

#include <span>

#include "accel/build/sah.h"
#include "accel/layout/binary.h"
#include "accel/walk/stack.h"

namespace alhazen {

/// Finds primitives by their boxes. Primitives are numbered by their place in the span of boxes; those whose
/// box is empty, infinite or NaN are never hit. Immutable; may be asked from any thread.
class Bvh {
  public:
    Bvh() = default;
    explicit Bvh(std::span<const Bounds3> boxes) : layout_(build_sah(boxes)) {}

    /// The box around all that can be hit; empty when there is nothing.
    const Bounds3& bounds() const { return layout_.bounds; }
    /// Primitives that can be hit.
    std::size_t primitive_count() const { return layout_.order.size(); }
    std::size_t bytes() const { return layout_.bytes(); }
    const BinaryLayout& layout() const { return layout_; }

    /// The nearest hit with 0 < t < ray.tmax, and of those at the same t the primitive with the lowest
    /// number; false (and hit untouched) when there is none. leaf: see walk.
    template <class Leaf>
    bool closest(const Ray& ray, Intersection& hit, Leaf&& leaf) const {
        return walk<Query::closest>(layout_, ray, hit, leaf);
    }
    /// Whether there is any hit with 0 < t < ray.tmax.
    template <class Leaf>
    bool any(const Ray& ray, Leaf&& leaf) const {
        Intersection hit;
        return walk<Query::any>(layout_, ray, hit, leaf);
    }

  private:
    BinaryLayout layout_;
};

} // namespace alhazen
