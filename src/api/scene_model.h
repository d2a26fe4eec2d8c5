/// What a public SceneModel holds.
#pragma once

#include "base/messages.h"
#include "describe/scene_description.h"
#include <alhazen/alhazen.h>

namespace alhazen {

struct SceneModel::Content {
    SceneDescription description;
    bool lenient = false;
    std::vector<Message> warnings; ///< of reading the file
};

} // namespace alhazen
