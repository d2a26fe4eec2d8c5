/// What shading normals do to light that is followed from the lights (Veach 1997, section 5.3).
#pragma once

#include "base/hit.h"

namespace alhazen {

/// A BSDF weighs light by the cosine at the shading normal, as if the surface stood as that says; but the
/// flux that meets the surface, and that a path from a light carries, goes by the true normal. The factor on
/// the BSDF's value for light that came from to_light and goes on along w, in world space.
inline float shading_correction(const Hit& hit, Vec3 to_light, Vec3 w) {
    const float shaded = abs_dot(hit.ns, w) * abs_dot(hit.ng, to_light);
    return shaded > 0 ? abs_dot(hit.ns, to_light) * abs_dot(hit.ng, w) / shaded : 0;
}

} // namespace alhazen
