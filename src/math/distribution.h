/// Distributions from tables: a row of heights, a grid of heights, a list of weights. Picture bars of a
/// histogram laid end to end: a uniform number falls into a bar as often as the bar is tall. Negative heights
/// count by their size; a table that is all zero is taken as uniform, so that every function stays defined.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"

namespace alhazen {

/// A density over [lo, hi) that is constant in each of n equal cells.
class PiecewiseConstant1D {
  public:
    struct Sample {
        float x = 0;
        float pdf = 1;
        int cell = 0;
    };

    /// One cell, uniform over [0, 1).
    PiecewiseConstant1D() : PiecewiseConstant1D(std::span<const float>(&unit_height, 1)) {}
    /// heights must not be empty, and hi > lo. Heights that are not finite count as 0.
    explicit PiecewiseConstant1D(std::span<const float> heights, float lo = 0, float hi = 1);

    /// u in [0, 1). Never gives a cell of height 0 (but when all are).
    Sample sample(float u) const;
    /// 0 outside [lo, hi).
    float pdf(float x) const;
    /// The u that gives x; x is clamped to the range.
    float invert(float x) const;

    /// Of the heights' sizes over the range; 0 when all are zero, though pdf() then is uniform.
    float integral() const { return integral_; }
    int size() const { return static_cast<int>(heights_.size()); }
    float lo() const { return lo_; }
    float hi() const { return hi_; }

  private:
    static constexpr float unit_height = 1;
    friend class PiecewiseConstant2D;

    float lo_, hi_;
    float integral_ = 0;
    std::vector<float> heights_;       ///< divided by their mean: densities times (hi - lo)
    std::vector<float> cdf_;           ///< n + 1 values from 0 to 1
    std::vector<std::uint32_t> hints_; ///< where to begin to look for a number's cell
};

/// A density over [0, 1)^2 that is constant in each of nx x ny equal cells (rows by their sums, then cells
/// within a row).
class PiecewiseConstant2D {
  public:
    struct Sample {
        Vec2 p;
        float pdf = 1;
        Vec2i cell;
    };

    /// One cell, uniform.
    PiecewiseConstant2D()
        : PiecewiseConstant2D(std::span<const float>(&PiecewiseConstant1D::unit_height, 1), 1, 1) {}
    /// heights holds ny rows of nx, nx and ny > 0.
    PiecewiseConstant2D(std::span<const float> heights, int nx, int ny);

    /// u in [0, 1)^2.
    Sample sample(Vec2 u) const;
    float pdf(Vec2 p) const;
    Vec2 invert(Vec2 p) const;
    /// Of the heights' sizes over the unit square.
    float integral() const { return rows_.integral(); }
    Vec2i size() const { return {nx_, rows_.size()}; }

  private:
    std::span<const float> row_cdf(int y) const;

    int nx_ = 1;
    PiecewiseConstant1D rows_;
    std::vector<float> cdf_; ///< nx + 1 values a row
    std::vector<std::uint32_t> hints_;
};

/// Draws one of n numbered things in proportion to its weight in constant time (Walker 1977, Vose 1991).
class AliasTable {
  public:
    struct Sample {
        std::uint32_t index = 0;
        float probability = 1;
        float u = 0; ///< a fresh uniform number in [0, 1), made of what is left of the one put in
    };

    AliasTable() = default;
    /// Weights that are negative or not finite count as 0; all 0 means all alike.
    explicit AliasTable(std::span<const float> weights);

    bool empty() const { return bins_.empty(); }
    std::size_t size() const { return bins_.size(); }
    /// u in [0, 1); the table must not be empty.
    Sample sample(float u) const;
    /// What sample gives index with.
    float probability(std::size_t index) const { return bins_[index].probability; }

  private:
    struct Bin {
        float keep = 1; ///< fraction of the bin that is its own
        std::uint32_t alias = 0;
        float probability = 0;
    };
    std::vector<Bin> bins_;
};

} // namespace alhazen
