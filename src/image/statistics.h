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
/// Rec. 709 luminance of a linear colour (ITU-R BT.709-6, 3.2).
inline float rec709_luminance(Vec3 rgb) {
    return 0.2126f * rgb.x + 0.7152f * rgb.y + 0.0722f * rgb.z;
}

} // namespace alhazen
