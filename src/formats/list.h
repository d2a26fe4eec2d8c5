/// The scene formats there are. To add one: a function that reads it, and a line here.
#pragma once

#include <array>
#include <filesystem>
#include <string_view>

#include "describe/scene_description.h"

namespace alhazen {

struct SceneFormat {
    std::string_view name;
    std::string_view suffix; ///< lower case, with the dot
    /// text is the file's, decompressed; relative file names are looked up from base_folder. Errors go to
    /// messages; throws SceneError when there are any.
    SceneDescription (*read)(std::string_view text, const std::filesystem::path& file,
                             const std::filesystem::path& base_folder, Messages& messages);
};

SceneDescription read_pbrt(std::string_view text, const std::filesystem::path& file,
                           const std::filesystem::path& base_folder, Messages& messages);

inline constexpr std::array scene_formats{SceneFormat{"pbrt-v4", ".pbrt", read_pbrt}};

} // namespace alhazen
