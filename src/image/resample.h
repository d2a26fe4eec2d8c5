/// Other sizes of an image.
#pragma once

#include "image/image.h"

namespace alhazen {

/// Every pixel of the result is the mean of the source's area under it, partly covered pixels by their part
/// (box filter). Sizes in 1 ... Image::max_side; a larger size repeats pixels. The mean of the image is kept.
Image resample_box(const Image& image, int width, int height);
/// Bilinear interpolation between pixel centres, borders clamped: for enlarging.
Image resample_bilinear(const Image& image, int width, int height);

} // namespace alhazen
