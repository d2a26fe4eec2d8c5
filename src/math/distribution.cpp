#include "math/distribution.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

namespace {

// Fills one row's densities and cumulative sums; gives the mean height.
double build_row(std::span<const float> heights, std::span<float> densities, std::span<float> cdf) {
    auto height = [&](std::size_t i) {
        return std::isfinite(heights[i]) ? static_cast<double>(std::abs(heights[i])) : 0.0;
    };
    const std::size_t n = heights.size();
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += height(i);
    const double count = static_cast<double>(n);
    double so_far = 0;
    cdf[0] = 0;
    for (std::size_t i = 0; i < n; ++i) {
        double share = sum > 0 ? height(i) / sum : 1 / count;
        so_far += share;
        densities[i] = static_cast<float>(share * count);
        cdf[i + 1] = std::min(1.0f, static_cast<float>(so_far));
    }
    // Rounding must not open a gap at the end, which would give a last cell of height 0.
    for (std::size_t i = n; i > 0; --i) {
        cdf[i] = 1;
        if (densities[i - 1] > 0) break;
    }
    return sum / count;
}

// The cell that u falls into, with the place in the cell in [0, 1).
struct CellPlace {
    std::size_t cell;
    float fraction;
};

// Cells are looked for between the hints for u's part of [0, 1), of which a row has so many and one more.
std::size_t hint_count(std::size_t cells) {
    return std::max<std::size_t>(cells / 4, 1);
}

// hints[i]: the cell that i / hint_count() falls into.
void build_hints(std::span<const float> cdf, std::span<std::uint32_t> hints) {
    const std::size_t last_cell = cdf.size() - 2, parts = hints.size() - 1;
    std::size_t cell = 0;
    for (std::size_t i = 0; i <= parts; ++i) {
        const float u = static_cast<float>(i) / static_cast<float>(parts);
        while (cell < last_cell && cdf[cell + 1] <= u) ++cell;
        hints[i] = static_cast<std::uint32_t>(cell);
    }
}

CellPlace find_cell(std::span<const float> cdf, std::span<const std::uint32_t> hints, float u) {
    // The first bound above u ends the cell, so that cells without width are never chosen.
    u = std::clamp(u, 0.0f, one_minus_epsilon);
    const std::size_t parts = hints.size() - 1;
    // Rounding may bring it to the next part, whose first cell is then this part's last.
    const auto part = static_cast<std::size_t>(u * static_cast<float>(parts));
    const std::size_t first =
        hints[part > 0 && u < static_cast<float>(part) / static_cast<float>(parts) ? part - 1 : part];
    const std::size_t last = hints[std::min(part + 1, parts)];
    auto after = std::upper_bound(cdf.begin() + static_cast<std::ptrdiff_t>(first) + 1,
                                  cdf.begin() + static_cast<std::ptrdiff_t>(last) + 1, u);
    auto cell = static_cast<std::size_t>(after - cdf.begin()) - 1;
    float width = cdf[cell + 1] - cdf[cell];
    float fraction = width > 0 ? (u - cdf[cell]) / width : 0;
    return {cell, std::clamp(fraction, 0.0f, one_minus_epsilon)};
}

// How much denser a cell is than a row's mean: with what rounding has left of it, since numbers fall into it
// with just that probability.
float cell_density(std::span<const float> cdf, std::size_t cell) {
    return (cdf[cell + 1] - cdf[cell]) * static_cast<float>(cdf.size() - 1);
}

// x in [0, 1] as cell and place in it.
CellPlace cell_at(float x, std::size_t n) {
    float scaled = std::clamp(x, 0.0f, 1.0f) * static_cast<float>(n);
    auto cell = std::min(static_cast<std::size_t>(scaled), n - 1);
    return {cell, std::min(1.0f, scaled - static_cast<float>(cell))};
}

float place_in_unit(CellPlace c, std::size_t n) {
    return std::min((static_cast<float>(c.cell) + c.fraction) / static_cast<float>(n), one_minus_epsilon);
}

} // namespace

PiecewiseConstant1D::PiecewiseConstant1D(std::span<const float> heights, float lo, float hi)
    : lo_(lo), hi_(hi), heights_(heights.size()), cdf_(heights.size() + 1),
      hints_(hint_count(heights.size()) + 1) {
    integral_ = static_cast<float>(build_row(heights, heights_, cdf_) * static_cast<double>(hi - lo));
    build_hints(cdf_, hints_);
}

PiecewiseConstant1D::Sample PiecewiseConstant1D::sample(float u) const {
    CellPlace c = find_cell(cdf_, hints_, u);
    float x = lo_ + (hi_ - lo_) * place_in_unit(c, heights_.size());
    return {x, heights_[c.cell] / (hi_ - lo_), static_cast<int>(c.cell)};
}

float PiecewiseConstant1D::pdf(float x) const {
    if (!(x >= lo_ && x < hi_)) return 0;
    return heights_[cell_at((x - lo_) / (hi_ - lo_), heights_.size()).cell] / (hi_ - lo_);
}

float PiecewiseConstant1D::invert(float x) const {
    CellPlace c = cell_at((x - lo_) / (hi_ - lo_), heights_.size());
    return lerp(c.fraction, cdf_[c.cell], cdf_[c.cell + 1]);
}

PiecewiseConstant2D::PiecewiseConstant2D(std::span<const float> heights, int nx, int ny)
    : nx_(nx), cdf_(heights.size() + static_cast<std::size_t>(ny)),
      hints_((hint_count(static_cast<std::size_t>(nx)) + 1) * static_cast<std::size_t>(ny)) {
    const auto width = static_cast<std::size_t>(nx);
    std::vector<float> means(static_cast<std::size_t>(ny));
    const std::size_t hints = hint_count(width) + 1;
    std::vector<float> densities(width);
    for (std::size_t y = 0; y < means.size(); ++y) {
        means[y] = static_cast<float>(build_row(heights.subspan(y * width, width), densities,
                                                std::span(cdf_).subspan(y * (width + 1), width + 1)));
        build_hints(row_cdf(static_cast<int>(y)), std::span(hints_).subspan(y * hints, hints));
    }
    rows_ = PiecewiseConstant1D(means);
}

std::span<const float> PiecewiseConstant2D::row_cdf(int y) const {
    const auto width = static_cast<std::size_t>(nx_) + 1;
    return std::span(cdf_).subspan(static_cast<std::size_t>(y) * width, width);
}

PiecewiseConstant2D::Sample PiecewiseConstant2D::sample(Vec2 u) const {
    auto row = rows_.sample(u.y);
    const std::size_t hints = hint_count(static_cast<std::size_t>(nx_)) + 1;
    CellPlace c = find_cell(
        row_cdf(row.cell), std::span(hints_).subspan(static_cast<std::size_t>(row.cell) * hints, hints), u.x);
    return {{place_in_unit(c, static_cast<std::size_t>(nx_)), row.x},
            row.pdf * cell_density(row_cdf(row.cell), c.cell),
            {static_cast<int>(c.cell), row.cell}};
}

float PiecewiseConstant2D::pdf(Vec2 p) const {
    if (!(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1)) return 0;
    auto y = cell_at(p.y, static_cast<std::size_t>(rows_.size())).cell;
    auto x = cell_at(p.x, static_cast<std::size_t>(nx_)).cell;
    return rows_.heights_[y] * cell_density(row_cdf(static_cast<int>(y)), x);
}

Vec2 PiecewiseConstant2D::invert(Vec2 p) const {
    auto y = cell_at(p.y, static_cast<std::size_t>(rows_.size())).cell;
    CellPlace c = cell_at(p.x, static_cast<std::size_t>(nx_));
    auto cdf = row_cdf(static_cast<int>(y));
    return {lerp(c.fraction, cdf[c.cell], cdf[c.cell + 1]), rows_.invert(p.y)};
}

AliasTable::AliasTable(std::span<const float> weights) : bins_(weights.size()) {
    auto weight = [&](std::size_t i) {
        return std::isfinite(weights[i]) && weights[i] > 0 ? static_cast<double>(weights[i]) : 0.0;
    };
    const double count = static_cast<double>(weights.size());
    double sum = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) sum += weight(i);
    // Scaled so that the mean is 1; what a bin lacks is filled from one that has too much.
    std::vector<double> scaled(weights.size());
    std::vector<std::uint32_t> poor, rich;
    for (std::uint32_t i = 0; i < weights.size(); ++i) {
        scaled[i] = sum > 0 ? weight(i) / sum * count : 1;
        bins_[i].probability = static_cast<float>(scaled[i] / count);
        bins_[i].alias = i;
        (scaled[i] < 1 ? poor : rich).push_back(i);
    }
    while (!poor.empty() && !rich.empty()) {
        std::uint32_t p = poor.back(), r = rich.back();
        poor.pop_back();
        bins_[p].keep = static_cast<float>(scaled[p]);
        bins_[p].alias = r;
        scaled[r] -= 1 - scaled[p];
        if (scaled[r] < 1) {
            rich.pop_back();
            poor.push_back(r);
        }
    }
    // What is left would be exactly 1 but for rounding; a weight of 0 must not come back that way.
    for (std::uint32_t p : poor) {
        if (bins_[p].probability > 0) continue;
        bins_[p].keep = 0;
        bins_[p].alias = static_cast<std::uint32_t>(
            std::max_element(bins_.begin(), bins_.end(),
                             [](const Bin& a, const Bin& b) { return a.probability < b.probability; }) -
            bins_.begin());
    }
}

AliasTable::Sample AliasTable::sample(float u) const {
    float scaled = u * static_cast<float>(bins_.size());
    auto i = std::min(static_cast<std::size_t>(scaled), bins_.size() - 1);
    float rest = std::clamp(scaled - static_cast<float>(i), 0.0f, one_minus_epsilon);
    const Bin& bin = bins_[i];
    if (rest < bin.keep)
        return {static_cast<std::uint32_t>(i), bin.probability, std::min(rest / bin.keep, one_minus_epsilon)};
    float again = (rest - bin.keep) / (1 - bin.keep);
    return {bin.alias, bins_[bin.alias].probability, std::clamp(again, 0.0f, one_minus_epsilon)};
}

} // namespace alhazen
