/// A scene without gloss: pbrt-v4's option "forcediffuse".
#pragma once

#include <memory>

#include "materials/material.h"

namespace alhazen {

/// The material made matte: at each hit its BSDF is replaced by a diffuse reflection of what it scatters in
/// all, as seen from there (by radiance, as in pbrt-v4: what is refracted into glass counts 1 / eta^2).
/// Borders between media stay, and so does relief; nothing passes beneath the surface. material must not be
/// nullptr.
std::unique_ptr<Material> forced_diffuse(std::unique_ptr<Material> material);

} // namespace alhazen
