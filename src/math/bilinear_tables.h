/// Functions on the unit square given by tables of their values at the nodes of a grid, bilinear in between;
/// and densities of that kind, with the map that draws from them and its inverse (Pharr et al. 2023, section
/// A.5.3; Dupuy and Jakob 2018, section 4.2). Tables come in series, one for each value of some parameter;
/// for parameters in between, neighbouring tables are blended.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/vec.h"

namespace alhazen {

/// A place between two nodes of an axis: index and index + 1, except that an axis of one node has no second.
struct AxisPlace {
    std::size_t index = 0;
    float fraction = 0; ///< 0 ... 1
};
/// nodes must increase and not be empty; x is clamped to them.
AxisPlace locate(std::span<const float> nodes, float x);

/// Which tables of a series to add up, and by how much. The weights sum to 1.
struct TableBlend {
    std::array<std::size_t, 4> table{};
    std::array<float, 4> weight{};
    int count = 0;

    void add(std::size_t table_, float weight_) {
        if (weight_ == 0) return;
        table[static_cast<std::size_t>(count)] = table_;
        weight[static_cast<std::size_t>(count++)] = weight_;
    }
};
/// Of a series of rows x columns tables, those around a place on both axes; a row's tables are neighbours.
TableBlend blend_around(AxisPlace row, AxisPlace column, std::size_t columns);

/// A series of tables of plain values.
class BilinearTables {
  public:
    /// Where a point lies: the first of its cell's four nodes within a table, and the place in the cell.
    struct Cell {
        std::size_t node = 0;
        float x = 0, y = 0;
    };

    BilinearTables() = default;
    /// ny rows of nx values, table by table; nx, ny >= 2.
    BilinearTables(std::vector<float> values, std::size_t nx, std::size_t ny);

    /// p is clamped to the unit square.
    Cell cell_at(Vec2 p) const;
    float eval(std::size_t table, Cell cell) const;
    float eval(Vec2 p) const { return eval(0, cell_at(p)); }
    std::size_t count() const { return values_.size() / (nx_ * ny_); }

  private:
    std::size_t nx_ = 2, ny_ = 2;
    std::vector<float> values_;
};

/// A series of densities over the unit square. Heights that are negative count as 0; a table that is all zero
/// is taken as uniform.
class BilinearDensities {
  public:
    struct Sample {
        Vec2 p;
        float pdf = 0;
    };

    BilinearDensities() = default;
    /// As for BilinearTables, of any scale.
    BilinearDensities(std::span<const float> heights, std::size_t nx, std::size_t ny);

    /// The point that u in [0, 1)^2 is mapped to, and its density.
    Sample sample(Vec2 u, const TableBlend& blend) const;
    /// The u that sample() maps to p, and the density at p; p is clamped to the unit square.
    Sample invert(Vec2 p, const TableBlend& blend) const;
    float pdf(Vec2 p, const TableBlend& blend) const;

  private:
    struct Corner;
    float blended(const std::vector<float>& of, std::size_t table_size, std::size_t at,
                  const TableBlend& blend) const;
    void normalize(std::size_t table, std::span<const float> heights);

    std::size_t nx_ = 2, ny_ = 2;
    std::vector<float> heights_; ///< densities
    std::vector<float> sums_;    ///< integral over x from 0 to each node of a row
    std::vector<float> cdf_;     ///< integral over y from row 0 to each row
};

} // namespace alhazen
