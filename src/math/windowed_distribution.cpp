#include "math/windowed_distribution.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

namespace {

struct Place {
    double at;
    int cell;
};

// Where a function that grows from lo to hi, linearly within each cell, reaches the fraction u of its growth
// from 0. nullopt where it does not grow.
template <class F>
std::optional<Place> invert(F grown, double lo, double hi, double u) {
    const double goal = u * grown(hi);
    int first = static_cast<int>(std::floor(lo)), last = std::max(first, static_cast<int>(std::ceil(hi)) - 1);
    // The first cell whose end is beyond the goal.
    while (first < last) {
        const int middle = first + (last - first) / 2;
        if (grown(middle + 1) > goal)
            last = middle;
        else
            first = middle + 1;
    }
    const double from = std::max(lo, static_cast<double>(first)), to = std::min(hi, first + 1.0);
    const double before = grown(from), growth = grown(to) - before;
    if (!(growth > 0)) return std::nullopt;
    return Place{std::clamp(from + (goal - before) / growth * (to - from), from, to), first};
}

} // namespace

WindowedPiecewiseConstant2D::WindowedPiecewiseConstant2D(std::span<const float> heights, int nx, int ny)
    : nx_(nx), ny_(ny), sums_(static_cast<std::size_t>(nx + 1) * static_cast<std::size_t>(ny + 1)) {
    const auto width = static_cast<std::size_t>(nx);
    for (std::size_t y = 0; y < static_cast<std::size_t>(ny); ++y) {
        double row = 0;
        for (std::size_t x = 0; x < width; ++x) {
            const float h = heights[y * width + x];
            row += std::isfinite(h) && h > 0 ? static_cast<double>(h) : 0;
            sums_[(y + 1) * (width + 1) + x + 1] = sums_[y * (width + 1) + x + 1] + row;
        }
    }
}

WindowedPiecewiseConstant2D::Cells WindowedPiecewiseConstant2D::in_cells(const Window& w) const {
    auto scaled = [](float v, int n) { return std::clamp(static_cast<double>(v), 0.0, 1.0) * n; };
    return {scaled(w.lo.x, nx_), scaled(w.hi.x, nx_), scaled(w.lo.y, ny_), scaled(w.hi.y, ny_)};
}

// Bilinear between the corners, which is exact since heights are constant within cells.
double WindowedPiecewiseConstant2D::integral_to(double x, double y) const {
    const int i = std::min(static_cast<int>(x), nx_ - 1), j = std::min(static_cast<int>(y), ny_ - 1);
    const double s = x - i, t = y - j;
    return (corner(i, j) * (1 - s) + corner(i + 1, j) * s) * (1 - t) +
           (corner(i, j + 1) * (1 - s) + corner(i + 1, j + 1) * s) * t;
}

double WindowedPiecewiseConstant2D::integral(const Cells& c) const {
    return (integral_to(c.x1, c.y1) - integral_to(c.x0, c.y1)) -
           (integral_to(c.x1, c.y0) - integral_to(c.x0, c.y0));
}

std::optional<WindowedPiecewiseConstant2D::Sample>
WindowedPiecewiseConstant2D::sample(Vec2 u, const Window& window) const {
    const Cells c = in_cells(window);
    const double total = integral(c);
    if (!(total > 0)) return std::nullopt;
    auto up_to_x = [&](double x) { return integral({c.x0, x, c.y0, c.y1}); };
    auto x = invert(up_to_x, c.x0, c.x1, static_cast<double>(u.x));
    if (!x) return std::nullopt;
    // Of one column of cells.
    auto up_to_y = [&](double y) { return integral({static_cast<double>(x->cell), x->cell + 1.0, c.y0, y}); };
    auto y = invert(up_to_y, c.y0, c.y1, static_cast<double>(u.y));
    if (!y) return std::nullopt;
    const Vec2i cell{x->cell, y->cell};
    const double per_cell = height(cell) / total;
    if (!(per_cell > 0)) return std::nullopt;
    return Sample{Vec2(static_cast<float>(x->at / nx_), static_cast<float>(y->at / ny_)),
                  static_cast<float>(per_cell * nx_ * ny_), cell};
}

float WindowedPiecewiseConstant2D::pdf(Vec2 p, const Window& window) const {
    if (!window.contains(p)) return 0;
    const double total = integral(in_cells(window));
    if (!(total > 0)) return 0;
    auto cell = [](float v, int n) {
        return std::clamp(static_cast<int>(v * static_cast<float>(n)), 0, n - 1);
    };
    return static_cast<float>(height({cell(p.x, nx_), cell(p.y, ny_)}) / total * nx_ * ny_);
}

} // namespace alhazen
