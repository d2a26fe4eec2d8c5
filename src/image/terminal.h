/// Images drawn as text, for terminals: as pixels where the terminal knows a protocol for that, else as
/// coloured half blocks. Colours are sRGB-encoded from clamped linear values. Whether a terminal can do it is
/// for the caller to find out.
#pragma once

#include <string>

#include "image/image.h"

namespace alhazen {

/// The size of the picture on the screen.
struct TerminalSize {
    /// Width in character cells, at least 1.
    int columns = 80;
    /// Width and height of a cell in pixels; terminals say so, 8 x 16 is common.
    Vec2i cell{8, 16};
};

/// The kitty graphics protocol: a PNG in base64 in chunks of at most 4096 bytes, scaled by the terminal to
/// the columns.
std::string draw_kitty(const Image& image, const TerminalSize& size);
/// Sixel graphics (DEC VT340), at most 252 colours: a uniform cube of 6 x 7 x 6 with ordered dithering.
std::string draw_sixel(const Image& image, const TerminalSize& size);
/// Half blocks with 24-bit colours: two pixels a cell, one above the other.
std::string draw_half_blocks(const Image& image, const TerminalSize& size);

} // namespace alhazen
