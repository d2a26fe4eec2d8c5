/// A distance field that is sampled on a grid, between whose samples it is trilinear; rays meet its surface
/// by solving the cubic that it is along them within a cell (Hansson-Soederlund, Evans and Akenine-Moeller
/// 2022, "Ray Tracing of Signed Distance Function Grids").
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "describe/grid_file.h"
#include "sdf/box.h"
#include "sdf/tessellate.h"

namespace alhazen {

/// Cubic polynomial, constant first.
using Cubic = std::array<double, 4>;

/// The least s in [0, end] from which on sign * c is negative; nullopt when there is none. The derivative's
/// roots cut the interval into stretches without turns, on which Newton's method with bisection cannot fail
/// (Hansson-Soederlund et al. 2022, section 3.2, after Marmitt et al. 2004).
std::optional<double> first_sign_change(const Cubic& c, double end, double sign);

/// Immutable. All coordinates are indices: samples stand at whole numbers, cell (i, j, k) reaches to i + 1
/// ...
class VoxelField {
  public:
    VoxelField() = default;
    /// Keeps the samples next to the surface.
    explicit VoxelField(const GridData& data);

    /// Around the cells that the surface passes through; empty when there are none.
    const Box& bounds() const { return bounds_; }
    std::size_t bytes() const {
        return bricks_.size() * sizeof(Brick) + index_.size() * sizeof(std::int32_t);
    }

    /// The least t in (0, tmax) at which o + t d passes through the surface; d need not have unit length.
    std::optional<double> first_crossing(Vec3d o, Vec3d d, double tmax) const;
    /// Of the trilinear interpolation; within the bounds.
    double value(Vec3d p) const;
    /// Its gradient, which jumps from cell to cell.
    Vec3d gradient(Vec3d p) const;
    /// Gradients of the eight cells around, each continued to p, interpolated between the cells' centres:
    /// continuous (section 4 of the paper).
    Vec3d smooth_gradient(Vec3d p) const;
    /// Triangles along the surface.
    std::vector<SdfTriangle> triangles() const;
    Vec3d move_to_surface(Vec3d p) const;

  private:
    static constexpr int side = GridBrick::size + 1;
    struct Brick {
        Vec3i origin;
        std::array<float, side * side * side> values{}; ///< with the first samples of the next bricks
        std::array<std::uint64_t, 8> crossed{};         ///< one bit a cell, a word a layer of z
        bool is_crossed(int x, int y, int z) const {
            return crossed[static_cast<std::size_t>(z)] >> (x + 8 * y) & 1;
        }
        double at(int x, int y, int z) const {
            return static_cast<double>(values[static_cast<std::size_t>(x + side * (y + side * z))]);
        }
    };
    /// The corners of a cell: s[x + 2 y + 4 z].
    using Corners8 = std::array<double, 8>;

    struct March;
    void keep_crossed(const GridData& data);
    void fill(Brick& b, const std::array<const GridBrick*, 8>& around) const;
    bool mark_crossed(Brick& b, const std::array<const GridBrick*, 8>& around) const;
    double sample(Vec3i p) const;
    const Brick* brick_at(Vec3i p) const;
    Corners8 corners(Vec3i cell) const;
    Vec3i cell_of(Vec3d p) const;

    Vec3i lo_, hi_;            ///< samples
    Vec3i brick_lo_, brick_n_; ///< in bricks
    std::vector<std::int32_t> index_;
    std::vector<Brick> bricks_;
    double background_ = 1;
    Box bounds_{Vec3d(1.0), Vec3d(-1.0)};
};

} // namespace alhazen
