#include "math/bilinear_tables.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

namespace {

/// A coordinate in 0 ... 1 among n evenly spaced nodes.
AxisPlace place_of(float x, std::size_t n) {
    const float scaled = std::clamp(x, 0.0f, 1.0f) * static_cast<float>(n - 1);
    const std::size_t index = std::min(static_cast<std::size_t>(scaled), n - 2);
    return {index, std::clamp(scaled - static_cast<float>(index), 0.0f, 1.0f)};
}
float position(AxisPlace place, std::size_t n) {
    return std::min((static_cast<float>(place.index) + place.fraction) / static_cast<float>(n - 1), 1.0f);
}

/// The last of the first n - 1 nodes whose cumulative value is at most u. Cells that hold nothing are passed.
template <class Cumulative>
std::size_t find_cell(Cumulative cumulative, std::size_t n, float u) {
    std::size_t lo = 0, hi = n - 1;
    while (hi - lo > 1) {
        const std::size_t middle = (lo + hi) / 2;
        (cumulative(middle) <= u ? lo : hi) = middle;
    }
    return lo;
}

/// Under a line from a at 0 to b at 1: the area left of t, and the t that has a given area to its left.
float area_under_line(float a, float b, float t) {
    return t * (a + 0.5f * (b - a) * t);
}
float invert_area_under_line(float a, float b, float area) {
    area = std::max(area, 0.0f);
    const float root = a + std::sqrt(std::max(0.0f, sqr(a) + 2 * (b - a) * area));
    return root > 0 ? std::min(2 * area / root, 1.0f) : 0;
}

} // namespace

AxisPlace locate(std::span<const float> nodes, float x) {
    if (nodes.size() < 2) return {};
    const auto after = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, x);
    const auto index = static_cast<std::size_t>(after - nodes.begin()) - 1;
    return {index, std::clamp((x - nodes[index]) / (nodes[index + 1] - nodes[index]), 0.0f, 1.0f)};
}

TableBlend blend_around(AxisPlace row, AxisPlace column, std::size_t columns) {
    TableBlend blend;
    const std::size_t first = row.index * columns + column.index;
    blend.add(first, (1 - row.fraction) * (1 - column.fraction));
    blend.add(first + 1, (1 - row.fraction) * column.fraction);
    blend.add(first + columns, row.fraction * (1 - column.fraction));
    blend.add(first + columns + 1, row.fraction * column.fraction);
    return blend;
}

BilinearTables::BilinearTables(std::vector<float> values, std::size_t nx, std::size_t ny)
    : nx_(nx), ny_(ny), values_(std::move(values)) {}

BilinearTables::Cell BilinearTables::cell_at(Vec2 p) const {
    const AxisPlace x = place_of(p.x, nx_), y = place_of(p.y, ny_);
    return {y.index * nx_ + x.index, x.fraction, y.fraction};
}

float BilinearTables::eval(std::size_t table, Cell cell) const {
    const float* corner = values_.data() + table * nx_ * ny_ + cell.node;
    return lerp(cell.y, lerp(cell.x, corner[0], corner[1]), lerp(cell.x, corner[nx_], corner[nx_ + 1]));
}

BilinearDensities::BilinearDensities(std::span<const float> heights, std::size_t nx, std::size_t ny)
    : nx_(nx), ny_(ny), heights_(heights.size()), sums_(heights.size()), cdf_(heights.size() / nx) {
    const std::size_t size = nx * ny;
    for (std::size_t table = 0; table * size < heights.size(); ++table)
        normalize(table, heights.subspan(table * size, size));
}

void BilinearDensities::normalize(std::size_t table, std::span<const float> heights) {
    auto height = [&](std::size_t i) { return static_cast<double>(std::max(heights[i], 0.0f)); };
    std::vector<double> sums(heights.size()), cdf(ny_);
    const auto cells_x = static_cast<double>(nx_ - 1), cells_y = static_cast<double>(ny_ - 1);
    for (std::size_t y = 0; y < ny_; ++y) {
        const std::size_t row = y * nx_;
        for (std::size_t x = 1; x < nx_; ++x)
            sums[row + x] = sums[row + x - 1] + (height(row + x - 1) + height(row + x)) / (2 * cells_x);
        if (y > 0) cdf[y] = cdf[y - 1] + (sums[row - 1] + sums[row + nx_ - 1]) / (2 * cells_y);
    }
    const double integral = cdf.back();
    if (!(integral > 0)) {
        const std::vector<float> flat(heights.size(), 1.0f);
        return normalize(table, flat);
    }
    for (std::size_t i = 0; i < heights.size(); ++i) {
        heights_[table * heights.size() + i] = static_cast<float>(height(i) / integral);
        sums_[table * heights.size() + i] = static_cast<float>(sums[i] / integral);
    }
    for (std::size_t y = 0; y < ny_; ++y) cdf_[table * ny_ + y] = static_cast<float>(cdf[y] / integral);
}

float BilinearDensities::blended(const std::vector<float>& of, std::size_t table_size, std::size_t at,
                                 const TableBlend& blend) const {
    float sum = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(blend.count); ++i)
        sum += blend.weight[i] * of[blend.table[i] * table_size + at];
    return sum;
}

/// The blended tables between two rows, at a place between them.
struct BilinearDensities::Corner {
    const BilinearDensities& of;
    const TableBlend& blend;
    AxisPlace row;

    std::size_t size() const { return of.nx_ * of.ny_; }
    float between_rows(const std::vector<float>& values, std::size_t x) const {
        const std::size_t at = row.index * of.nx_ + x;
        return lerp(row.fraction, of.blended(values, size(), at, blend),
                    of.blended(values, size(), at + of.nx_, blend));
    }
    float height(std::size_t x) const { return between_rows(of.heights_, x); }
    /// Integral over x up to a node.
    float sum(std::size_t x) const { return between_rows(of.sums_, x); }
    float row_total(std::size_t y) const {
        return of.blended(of.sums_, size(), y * of.nx_ + of.nx_ - 1, blend);
    }
    float cdf(std::size_t y) const { return of.blended(of.cdf_, of.ny_, y, blend); }
};

BilinearDensities::Sample BilinearDensities::sample(Vec2 u, const TableBlend& blend) const {
    Corner at{*this, blend, {}};
    const std::size_t y = find_cell([&](std::size_t i) { return at.cdf(i); }, ny_, u.y);
    const float in_row = (u.y - at.cdf(y)) * static_cast<float>(ny_ - 1);
    at.row = {y, invert_area_under_line(at.row_total(y), at.row_total(y + 1), in_row)};

    const float wanted = u.x * at.sum(nx_ - 1);
    const std::size_t x = find_cell([&](std::size_t i) { return at.sum(i); }, nx_, wanted);
    const float in_cell = (wanted - at.sum(x)) * static_cast<float>(nx_ - 1);
    const float left = at.height(x), right = at.height(x + 1);
    const AxisPlace column{x, invert_area_under_line(left, right, in_cell)};
    return {{position(column, nx_), position(at.row, ny_)}, lerp(column.fraction, left, right)};
}

BilinearDensities::Sample BilinearDensities::invert(Vec2 p, const TableBlend& blend) const {
    const AxisPlace x = place_of(p.x, nx_), y = place_of(p.y, ny_);
    const Corner at{*this, blend, y};
    const float left = at.height(x.index), right = at.height(x.index + 1);
    const float sum =
        at.sum(x.index) + area_under_line(left, right, x.fraction) / static_cast<float>(nx_ - 1);
    const float total = at.sum(nx_ - 1);
    const float rows = area_under_line(at.row_total(y.index), at.row_total(y.index + 1), y.fraction) /
                       static_cast<float>(ny_ - 1);
    const Vec2 u{total > 0 ? sum / total : 0.5f, at.cdf(y.index) + rows};
    return {{std::clamp(u.x, 0.0f, 1.0f), std::clamp(u.y, 0.0f, 1.0f)}, lerp(x.fraction, left, right)};
}

float BilinearDensities::pdf(Vec2 p, const TableBlend& blend) const {
    const AxisPlace x = place_of(p.x, nx_), y = place_of(p.y, ny_);
    const Corner at{*this, blend, y};
    return lerp(x.fraction, at.height(x.index), at.height(x.index + 1));
}

} // namespace alhazen
