/// The production structure in memory: nodes of eight children and the leaves' triangles, in one block.
#pragma once

#include "accel/layout/collapse.h"
#include "accel/structure.h"
#include "accel/wide/kernel.h"
#include "base/big_array.h"

namespace alhazen {

/// Immutable once built. Needs nothing of the primitives any more, but their tests for those that are not
/// plain triangles.
class WideLayout {
  public:
    WideLayout() = default;
    /// The tree's bounds and leaves; throws std::length_error when they need more than 4 GB.
    WideLayout(const Tree& tree, const Primitives& primitives);

    const char* base() const { return memory_.data(); }
    /// The root's reference; wide_done when there is nothing.
    std::uint32_t root() const { return root_; }
    LayoutStats stats() const { return {nodes_, depth_, memory_.size()}; }
    /// Expected cost of a ray in node visits, by the model by which the tree was collapsed.
    double cost() const { return cost_; }

  private:
    BigArray<char> memory_;
    std::uint32_t root_ = wide_done;
    std::size_t nodes_ = 0;
    int depth_ = 0;
    double cost_ = 0;
};

/// A node's test of eight boxes and a leaf's of eight triangles are taken for equally long: leaves of 0.7 to
/// 2 times a node's cost were measured to make no difference beyond the noise of measuring, 5 %.
inline constexpr CollapseCosts wide_costs{};

} // namespace alhazen
