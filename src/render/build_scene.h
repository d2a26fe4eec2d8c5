/// From shapes, objects and lights of a description to a Scene.
#pragma once

#include <memory>
#include <unordered_map>

#include "describe/scene_description.h"
#include "materials/material_set.h"
#include "media/medium_set.h"
#include "scene/scene.h"

namespace alhazen {

/// What is said of a Motion that MovingTransform refuses.
inline constexpr std::string_view no_movement = "there is no way from the transformation at the start of the "
                                                "motion to that at its end: each must be affine and "
                                                "invertible, and both must mirror, or neither";

/// What a shape was in the description: for messages after it is built.
struct ShapeSource {
    std::string type;
    Place place;
};
using ShapeSources = std::unordered_map<const Shape*, ShapeSource>;

/// context.textures and .materials must be set; materials and media are those of description. Every
/// object gets a structure as accel says. sources, if any, gets all shapes. Returns nullptr when errors were
/// added to context.messages.
std::unique_ptr<Scene> build_scene(SceneDescription& description, const MaterialSet& materials,
                                   const MediumSet& media, const AccelChoice& accel, BuildContext& context,
                                   ShapeSources* sources = nullptr);

} // namespace alhazen
