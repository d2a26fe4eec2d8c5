#include "render/families.h"

#include "cameras/camera.h"
#include "film/film.h"
#include "film/filter.h"
#include "integrators/integrator.h"
#include "lights/area_light.h"
#include "lights/light.h"
#include "materials/material.h"
#include "media/medium.h"
#include "render/accelerator.h"
#include "samplers/sampler.h"
#include "sdf/sdf.h"
#include "shapes/shape.h"
#include "textures/texture_set.h"

namespace alhazen {

namespace {

template <class Family>
std::function<std::vector<KindDoc>()> docs_of(const KindList<Family>& (*list)()) {
    return [list] {
        std::vector<KindDoc> docs;
        for (const auto& kind : list().all()) docs.push_back(kind.doc());
        return docs;
    };
}

} // namespace

const std::vector<FamilyInfo>& families() {
    static const std::vector<FamilyInfo> list{
        {"integrator", "Integrator", "How the light that reaches the camera is computed.",
         docs_of(&integrator_kinds)},
        {"camera", "Camera", "Where the picture is taken from, and through what lens.",
         docs_of(&camera_kinds)},
        {"film", "Film", "How light becomes pixels.", docs_of(&film_kinds)},
        {"filter", "PixelFilter", "How far around a pixel its samples lie, and how they count.",
         docs_of(&filter_kinds)},
        {"sampler", "Sampler", "Where the random numbers come from.", docs_of(&sampler_kinds)},
        {"accelerator", "Accelerator", "How the scene is arranged so that rays find what they meet.",
         docs_of(&accelerator_kinds)},
        {"shape", "Shape", "Surfaces.", docs_of(&shape_kinds)},
        {"sdf", "Sdf \"name\"",
         "Signed distance fields: bodies, and operators that make bodies of others, for Shape \"sdf\".",
         docs_of(&sdf_kinds)},
        {"material", "Material", "What surfaces do to light.", docs_of(&material_kinds)},
        {"medium", "MakeNamedMedium \"name\" \"string type\"", "What fills space between surfaces.",
         docs_of(&medium_kinds)},
        {"float-texture", "Texture \"name\" \"float\"", "Numbers that vary over surfaces.",
         docs_of(&float_texture_kinds)},
        {"spectrum-texture", "Texture \"name\" \"spectrum\"", "Colours that vary over surfaces.",
         docs_of(&spectrum_texture_kinds)},
        {"light", "LightSource", "Where light comes from.", docs_of(&light_kinds)},
        {"area-light", "AreaLightSource", "What makes the shapes that follow shine.",
         docs_of(&area_light_kinds)},
    };
    return list;
}

} // namespace alhazen
