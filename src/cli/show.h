/// A finished picture on the screen.
#pragma once

#include <filesystem>

#include "image/image.h"

namespace alhazen {

/// Opens the file in the desktop's image viewer where there is a desktop; else draws the image in the
/// terminal, by the best means it has; else (no desktop, no terminal) does nothing. file must be something a
/// viewer can show, or empty.
void show_picture(const Image& image, const std::filesystem::path& file);

} // namespace alhazen
