/// From a description to everything a picture needs.
#pragma once

#include <memory>

#include "cameras/camera.h"
#include "describe/scene_description.h"
#include "film/film.h"
#include "film/filter.h"
#include "integrators/integrator.h"
#include "materials/material_set.h"
#include "media/medium_set.h"
#include "render/build_scene.h"
#include "render/scene_options.h"
#include "render/settings.h"
#include "samplers/sampler.h"
#include "scene/scene.h"
#include "textures/texture_set.h"

namespace alhazen {

/// A scene with the camera, film and so on to render it with.
struct World {
    ColorMode mode = ColorMode::spectral;
    TextureSet textures;
    MaterialSet materials;
    MediumSet media;
    std::unique_ptr<Scene> scene;
    std::unique_ptr<Camera> camera;
    std::unique_ptr<Film> film;
    std::unique_ptr<Filter> filter;
    std::unique_ptr<Sampler> sampler;
    std::unique_ptr<Integrator> integrator;
    int spp = 1;
    std::uint64_t seed = 0;
    int paths_in_flight = 1;
    SceneOptionValues options;

    PictureOrder picture() const {
        return {*scene, *camera, *film, *filter, *sampler, mode, spp, seed, paths_in_flight};
    }
};

/// Builds the world; throws SceneError with every error found. Warnings stay in messages. sources as for
/// build_scene.
std::unique_ptr<World> build_world(SceneDescription description, const RenderSettings& settings,
                                   Messages& messages, ShapeSources* sources = nullptr);

/// Applies "family.parameter=value", "material.NAME.parameter=value", "light.NUMBER.parameter=value",
/// "texture.NAME.parameter=value" or "camera.parameter=value" to the description. Errors go to messages.
void apply_override(SceneDescription& description, const std::string& text, Messages& messages);

} // namespace alhazen
