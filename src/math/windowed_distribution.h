/// A grid of heights of which only a rectangle counts at a time: the pixels of a sky that are seen through a
/// window, which differ from place to place. Integrals over rectangles come from a summed-area table (Crow
/// 1984), and drawing searches that table (Bitterli, Wyman and Pharr 2015, "Portal-masked environment map
/// sampling").
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/vec.h"

namespace alhazen {

/// A density over rectangles of the unit square that is constant in each of nx x ny equal cells.
class WindowedPiecewiseConstant2D {
  public:
    /// A rectangle in the unit square.
    struct Window {
        Vec2 lo, hi;
        bool contains(Vec2 p) const { return p.x >= lo.x && p.x <= hi.x && p.y >= lo.y && p.y <= hi.y; }
    };
    struct Sample {
        Vec2 p;
        float pdf = 1;
        Vec2i cell;
    };

    /// heights holds ny rows of nx, nx and ny > 0. Heights that are negative or not finite count as 0.
    WindowedPiecewiseConstant2D(std::span<const float> heights, int nx, int ny);

    /// u in [0, 1)^2; nullopt where the window has no area or all of it is 0.
    std::optional<Sample> sample(Vec2 u, const Window& window) const;
    /// Density with which sample() gives p; 0 outside the window.
    float pdf(Vec2 p, const Window& window) const;

  private:
    /// A rectangle in units of cells.
    struct Cells {
        double x0, x1, y0, y1;
    };
    Cells in_cells(const Window& window) const;
    double corner(int x, int y) const {
        return sums_[static_cast<std::size_t>(y) * static_cast<std::size_t>(nx_ + 1) +
                     static_cast<std::size_t>(x)];
    }
    double integral_to(double x, double y) const;
    double integral(const Cells& c) const;
    double height(Vec2i cell) const {
        return integral(
            {static_cast<double>(cell.x), cell.x + 1.0, static_cast<double>(cell.y), cell.y + 1.0});
    }

    int nx_, ny_;
    std::vector<double> sums_; ///< of the cells left of and above each corner; ny + 1 rows of nx + 1
};

} // namespace alhazen
