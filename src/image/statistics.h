/// Numbers about whole images.
#pragma once

#include <cstddef>
#include <vector>

#include "image/image.h"

namespace alhazen {

/// Mean of each channel over all pixels, summed in double precision.
std::vector<double> channel_means(const Image& image);
/// How many values are NaN or infinite.
std::size_t count_non_finite(const Image& image);

} // namespace alhazen
