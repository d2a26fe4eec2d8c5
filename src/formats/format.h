/// Scene files: text in, neutral scene out. Which formats there are is said by list.h.
#pragma once

#include <filesystem>
#include <string_view>

#include "describe/scene_description.h"

namespace alhazen {

/// Reads a scene file in the format its suffix names; a ".gz" after it is looked past. Every error found goes
/// to messages; when there are any, throws SceneError with all of them. Warnings stay in messages.
SceneDescription read_scene(const std::filesystem::path& file, Messages& messages);

/// Reads a scene in pbrt-v4's language from memory; messages name the place "<string>". Included files are
/// looked up from base_folder. Throws as read_scene.
SceneDescription read_pbrt_string(std::string_view text, const std::filesystem::path& base_folder,
                                  Messages& messages);

} // namespace alhazen
