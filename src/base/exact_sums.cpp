#include "base/exact_sums.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

ExactSums::ExactSums(std::size_t count) : low_(count), high_(count) {
    reset();
}

void ExactSums::reset() {
    std::fill(low_.all().begin(), low_.all().end(), low_zero);
    std::fill(high_.all().begin(), high_.all().end(), 0);
}

void ExactSums::add_large(std::size_t i, double v) {
    const double whole = std::floor(std::clamp(v / low_range, -0x1p48, 0x1p48));
    const double rest = std::clamp(v - whole * low_range, 0.0, low_range);
    std::atomic_ref(high_[i]).fetch_add(static_cast<std::int64_t>(whole), std::memory_order_relaxed);
    // In quarters, since the range of the low word is twice that of signed numbers.
    for (int quarter = 0; quarter < 4; ++quarter) add_units(i, static_cast<std::int64_t>(rest / 4 * units));
}

double ExactSums::sum(std::size_t i) const {
    const auto low = static_cast<std::int64_t>(low_[i] - low_zero);
    return static_cast<double>(high_[i]) * low_range + static_cast<double>(low) / units;
}

} // namespace alhazen
