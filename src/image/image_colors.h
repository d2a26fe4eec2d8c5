/// Which colour space an image's values are in.
#pragma once

#include "color/color_space.h"
#include "image/image.h"

namespace alhazen {

/// The space that the image's metadata name under "color_space", as reading sets it; sRGB where they name
/// none.
const RgbColorSpace& color_space_of(const Image& image);

/// The image with its channels R, G, B, if it has them, in linear sRGB, and without the word that it was
/// anything else. Colours outside of sRGB have negative components.
Image in_srgb(Image image);

} // namespace alhazen
