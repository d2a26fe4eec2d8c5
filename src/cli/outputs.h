/// Files that a command is going to write.
#pragma once

#include <string>
#include <vector>

namespace alhazen {

/// Whether the files (empty names are none) can be written without losing anything: each into a folder that
/// is there, none over the input or over another one. Throws std::runtime_error where not.
void check_outputs(const std::string& input, const std::vector<std::string>& files);
/// Whether the file is no folder, and its own is there and can be written to: throws std::runtime_error where
/// not.
void check_output_folder(const std::string& file);
/// Says what is wrong with a picture's name or folder before an hour of rendering rather than after it:
/// throws std::runtime_error.
void check_picture_output(const std::string& file);

} // namespace alhazen
