/// Files that a command is going to write.
#pragma once

#include <string>

namespace alhazen {

/// Whether the file's folder is there and can be written to: throws std::runtime_error where not.
void check_output_folder(const std::string& file);
/// Says what is wrong with a picture's name or folder before an hour of rendering rather than after it:
/// throws std::runtime_error.
void check_picture_output(const std::string& file);

} // namespace alhazen
