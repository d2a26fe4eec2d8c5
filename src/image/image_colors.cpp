#include "image/image_colors.h"

namespace alhazen {

const RgbColorSpace& color_space_of(const Image& image) {
    const auto found = image.info.metadata.find("color_space");
    if (found == image.info.metadata.end()) return srgb_space();
    const RgbColorSpace* space = find_color_space(found->second);
    return space ? *space : srgb_space();
}

Image in_srgb(Image image) {
    const RgbColorSpace& space = color_space_of(image);
    image.info.metadata.erase("color_space");
    if (&space == &srgb_space() || !image.has_rgb()) return image;
    const Matrix3 srgb_from_rgb = convert_rgb(space, srgb_space());
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) image.set_rgb(x, y, srgb_from_rgb * image.rgb(x, y));
    return image;
}

} // namespace alhazen
