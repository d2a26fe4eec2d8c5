/// What a scene's Option directives ask for.
#pragma once

#include "base/messages.h"
#include "describe/scene_description.h"

namespace alhazen {

/// The names are those of pbrt-v4; the rest of its options change nothing in a picture.
struct SceneOptionValues {
    bool disablepixeljitter =
        false; ///< rays through the pixels' and the lens' centres, at half of the exposure
    bool disablewavelengthjitter = false; ///< the same four wavelengths for all
    bool disabletexturefiltering = false; ///< textures are looked up at points
    bool forcediffuse = false;            ///< materials are matte, of the same albedo (forced_diffuse())
    float displacementedgescale = 1;      ///< factor of the edges that displaced meshes are cut into
};

/// Adds errors for values that are out of range, and warns of options that should do something and do
/// nothing.
SceneOptionValues read_scene_options(const SceneDescription& scene, Messages& messages);

} // namespace alhazen
