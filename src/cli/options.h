/// Command-line options about the scene that several subcommands take.
#pragma once

#include "render/settings.h"

namespace CLI {
class App;
}

namespace alhazen {

struct SceneOptions {
    RenderSettings settings;
    bool lenient = false;
};

void add_scene_options(CLI::App& command, SceneOptions& options);

} // namespace alhazen
