#include "film/filter_table.h"

#include <cmath>

namespace alhazen {

void FilterCurve::build(const std::vector<float>& heights, float radius) {
    table_ = PiecewiseConstant1D(heights, -radius, radius);
    double sum = 0;
    double size = 0;
    for (float h : heights) {
        sum += static_cast<double>(h);
        size += std::abs(static_cast<double>(h));
    }
    auto weight = static_cast<float>(size / sum);
    weights_.clear();
    for (float h : heights) weights_.push_back(h < 0 ? -weight : weight);
    integral_ =
        static_cast<float>(sum * 2 * static_cast<double>(radius) / static_cast<double>(heights.size()));
}

} // namespace alhazen
