/// Samples of a grid file where it has any: trilinear between them, 0 elsewhere.
#pragma once

#include <cstdint>
#include <vector>

#include "base/bounds.h"
#include "describe/grid_file.h"

namespace alhazen {

/// All coordinates are indices: samples stand at whole numbers.
class SparseField {
  public:
    SparseField() = default;
    explicit SparseField(GridData data);

    bool empty() const { return bricks_.empty(); }
    /// From the first sample to one behind the last.
    Bounds3 bounds() const;
    /// Of the samples.
    float lookup(Vec3 p) const;
    /// The largest sample that a place in the box depends on; at least 0.
    float largest(const Bounds3& box) const;
    const Matrix4& object_from_index() const { return object_from_index_; }

  private:
    const GridBrick* brick_at(Vec3i sample) const;
    float sample(Vec3i p) const;

    Vec3i lo_, hi_;                   ///< first and last sample
    Vec3i first_brick_, count_;       ///< in bricks
    std::vector<std::int32_t> index_; ///< of the brick, -1: none
    std::vector<GridBrick> bricks_;
    Matrix4 object_from_index_;
};

} // namespace alhazen
