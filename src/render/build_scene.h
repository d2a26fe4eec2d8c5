/// From shapes, objects and lights of a description to a Scene.
#pragma once

#include <memory>

#include "describe/scene_description.h"
#include "materials/material_set.h"
#include "scene/scene.h"

namespace alhazen {

/// context.textures and .materials must be set; materials are those of description, in its order. Every
/// object gets a structure as accel says. Returns nullptr when errors were added to context.messages.
std::unique_ptr<Scene> build_scene(SceneDescription& description, const MaterialSet& materials,
                                   const AccelChoice& accel, BuildContext& context);

} // namespace alhazen
