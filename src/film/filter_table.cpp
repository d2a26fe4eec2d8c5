#include "film/filter_table.h"

namespace alhazen {

void FilterCurve::build(const std::vector<float>& heights, float radius) {
    table_ = PiecewiseConstant1D(heights, -radius, radius);
    double sum = 0;
    signs_.clear();
    for (float h : heights) {
        sum += static_cast<double>(h);
        signs_.push_back(h < 0 ? -1.0f : 1.0f);
    }
    integral_ =
        static_cast<float>(sum * 2 * static_cast<double>(radius) / static_cast<double>(heights.size()));
}

} // namespace alhazen
