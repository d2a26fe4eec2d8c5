/// How wide a camera's pixels are.
#pragma once

#include "base/pixel_cone.h"
#include "cameras/camera.h"

namespace alhazen {

/// Found by comparing the rays of neighbouring pixels at some places of the film, of which the narrowest
/// counts. Pixels of many samples are narrower, down to an eighth, since each sample stands for a part of one
/// (as pbrt-v4).
PixelCone pixel_cone(const Camera& camera, Vec2i resolution, int spp);

} // namespace alhazen
