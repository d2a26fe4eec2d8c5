#include "image/statistics.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

std::vector<double> channel_means(const Image& image) {
    auto channels = static_cast<std::size_t>(image.channels());
    std::vector<double> sums(channels, 0.0);
    auto values = image.values();
    for (std::size_t i = 0; i < values.size(); ++i) sums[i % channels] += static_cast<double>(values[i]);
    const std::size_t pixels = values.size() / channels;
    for (double& s : sums) s /= static_cast<double>(pixels);
    return sums;
}

std::size_t count_non_finite(const Image& image) {
    auto values = image.values();
    return static_cast<std::size_t>(
        std::count_if(values.begin(), values.end(), [](float v) { return !std::isfinite(v); }));
}

} // namespace alhazen
