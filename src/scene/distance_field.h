/// Distances from triangles on a regular grid, as rays march through them.
#pragma once

#include <vector>

#include "accel/build/tree.h"
#include "base/big_array.h"
#include "base/vec.h"
#include "scene/march/kernel.h"
#include "sdf/mesh_distance.h"

namespace alhazen {

class DistanceField {
  public:
    /// cells along the longest side of all triangles together, whose corners are finite. Builds on the
    /// threads of the enclosing with_threads. Throws std::runtime_error when the triangles have no
    /// extent, or too much.
    DistanceField(const std::vector<Corners>& triangles, int cells);

    /// The first sample's place, and the samples' distance.
    Vec3d lo() const { return lo_; }
    double cell() const { return cell_; }
    /// The triangle that is nearest to the sample, whose plane it knows.
    std::uint32_t triangle(std::uint32_t sample) const { return triangles_[sample]; }
    void prefetch_triangle(std::uint32_t sample) const { __builtin_prefetch(&triangles_[sample]); }
    /// Good as long as this.
    MarchField march_field() const;
    std::size_t bytes() const {
        return (samples_.size() + bricks_.size() + triangles_.size()) * sizeof(std::uint32_t);
    }

  private:
    static constexpr int side = 4; ///< of a brick, samples
    static constexpr std::size_t brick_size = 64;
    Vec3d place(Vec3i sample) const { return lo_ + Vec3d(sample) * cell_; }
    Vec3i first_sample(std::size_t brick) const;
    std::vector<float> measure_bricks(const MeshDistance& mesh) const;
    void fill(std::size_t brick, float distance, const MeshDistance& mesh,
              const std::vector<Corners>& triangles);

    Vec3d lo_;
    double cell_ = 1;
    Vec3i n_{0, 0, 0}, bricks_along_{0, 0, 0};
    std::vector<std::uint32_t> bricks_;
    BigArray<MarchSample> samples_;
    BigArray<std::uint32_t> triangles_; ///< one a sample
};

} // namespace alhazen
