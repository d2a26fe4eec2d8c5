/// Files that a command is going to write.
#pragma once

#include <string>

namespace alhazen {

/// Says what is wrong with a picture's name or folder before an hour of rendering rather than after it:
/// throws std::runtime_error.
void check_picture_output(const std::string& file);

} // namespace alhazen
