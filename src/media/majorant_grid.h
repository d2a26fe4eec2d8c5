/// Bounds of a medium's density, cell by cell, and the stretches in which a ray sees them.
#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "base/bounds.h"
#include "base/ray.h"

namespace alhazen {

/// A box of cells, each with an upper bound of the density in it; there is nothing outside. As constructed it
/// reaches everywhere and has the density 1.
class MajorantGrid {
  public:
    MajorantGrid() = default;
    /// largest(cell): the least upper bound that is known in a part of the box; >= 0 and finite.
    MajorantGrid(const Bounds3& box, Vec3i cells, const std::function<float(const Bounds3&)>& largest);

    bool is_everywhere() const { return densities_.empty(); }
    const Bounds3& box() const { return box_; }
    Vec3i cells() const { return cells_; }
    const Vec3& cell_size() const { return cell_size_; }
    const Vec3& cells_per_length() const { return cells_per_length_; }
    float density(Vec3i cell) const {
        return densities_[static_cast<std::size_t>(cell.x + cells_.x * (cell.y + cells_.y * cell.z))];
    }

  private:
    Bounds3 box_;
    Vec3i cells_;
    Vec3 cell_size_, cells_per_length_;
    std::vector<float> densities_;
};

/// A part of a ray in which the bound is the same.
struct MajorantSegment {
    float begin = 0, end = 0; ///< along the ray
    float density = 0;
};

/// The segments of a ray, in order, by a three-dimensional DDA (Amanatides and Woo 1987).
class MajorantWalk {
  public:
    /// The ray is in the grid's space; d of any length. The grid must outlive the walk.
    MajorantWalk(const MajorantGrid& grid, const Ray& ray);

    /// nullopt behind the last.
    std::optional<MajorantSegment> next();

    /// Whether the ray is in a cell of the grid, and in which one the next segment will be.
    bool is_in_cell() const { return !is_over_ && !grid_.is_everywhere(); }
    Vec3i cell() const { return cell_; }
    /// Where the next segment begins, along the ray; the ray's end when there is none.
    float begin() const { return is_over_ ? end_ : t_; }
    /// The ray ends here if it did not end before; not before where the next segment begins.
    void limit(float tmax);

  private:
    const MajorantGrid& grid_;
    float t_ = 0, end_ = 0;
    bool is_over_ = false;
    Vec3i cell_, step_;
    Vec3 next_t_, delta_t_; ///< where the next border of each axis is, and from one to the next
};

// Here, so that a segment stays in registers: it is asked for again and again.
inline std::optional<MajorantSegment> MajorantWalk::next() {
    if (is_over_) return std::nullopt;
    if (grid_.is_everywhere()) {
        is_over_ = true;
        return MajorantSegment{0, end_, 1};
    }
    const int axis =
        next_t_.x < next_t_.y ? (next_t_.x < next_t_.z ? 0 : 2) : (next_t_.y < next_t_.z ? 1 : 2);
    MajorantSegment segment{t_, std::clamp(next_t_[axis], t_, end_), grid_.density(cell_)};
    cell_[axis] += step_[axis];
    if (next_t_[axis] >= end_ || cell_[axis] < 0 || cell_[axis] >= grid_.cells()[axis]) {
        segment.end = end_;
        is_over_ = true;
    }
    next_t_[axis] += delta_t_[axis];
    t_ = segment.end;
    return segment;
}

} // namespace alhazen
