/// What a camera ray sees first, for films that keep more than light.
#pragma once

#include "base/vec.h"
#include "color/wavelengths.h"

namespace alhazen {

/// World space.
struct VisibleSurface {
    bool is_there = false; ///< where not, the rest means nothing
    float time = 0;        ///< when it is seen
    Vec3 p;
    Vec3 n, ns; ///< geometric and shading normal, towards the camera
    Vec2 uv;
    Vec3 dpdx, dpdy; ///< how the point moves over the surface from pixel to pixel, to the right and down
    Spectrum albedo; ///< share of light scattered, into all directions, in these wavelengths
    Wavelengths lambda;
};

} // namespace alhazen
