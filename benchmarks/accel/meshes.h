/// Scenes of triangles made by formula, each of a kind that is hard in its own way.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "describe/scene_description.h"

namespace alhazen::bench {

struct GeneratedScene {
    std::string name;
    std::string about;
    bool is_short = false; ///< part of the short set
    std::function<SceneDescription()> make;
};

/// Terrains of 1 and 10 million triangles, hair, a hall, the hall with statues, a stadium.
std::vector<GeneratedScene> generated_scenes();

} // namespace alhazen::bench
