/// Words on pictures.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "image/image.h"

namespace alhazen {

/// Pixels that the text takes when each of the font's pixels is a square of scale x scale. Characters other
/// than printable ASCII are drawn as question marks.
Vec2i text_size(std::string_view text, int scale);
/// Draws the text with its upper left corner there; what does not fit on the image is cut off.
void draw_text(Image& image, Vec2i corner, std::string_view text, int scale, Vec3 color);

/// A picture and what to write below it.
struct Captioned {
    Image image;
    std::vector<std::string> lines;
};
/// All pictures on one sheet, in rows as near to a square as can be, each with its caption below. There must
/// be one at least.
Image captioned_sheet(const std::vector<Captioned>& pictures);

} // namespace alhazen
