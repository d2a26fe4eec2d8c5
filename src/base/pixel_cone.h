/// How wide a pixel is, seen from the camera: what textures blur over.
#pragma once

#include "base/vec.h"

namespace alhazen {

/// Around every line of sight, at a point of the scene seen straight from the camera, whichever way light
/// went there: the width depends on the place alone, so that all paths agree on what the surface is there.
struct PixelCone {
    Vec3 origin;      ///< the camera's place; not used where parallel is not zero
    Vec3 parallel;    ///< unit direction of all lines of sight, where they have one; else zero
    float width = 0;  ///< at the origin
    float spread = 0; ///< growth of the width with distance

    bool is_parallel() const { return parallel.x != 0 || parallel.y != 0 || parallel.z != 0; }

    /// The axes of the ellipse in which the surface at p with unit normal n cuts the cone around the line of
    /// sight; each as long as a pixel is wide in its direction.
    struct Ellipse {
        Vec3 narrow, wide;
    };
    Ellipse on_surface(Vec3 p, Vec3 n) const {
        Vec3 sight = parallel;
        float w = width;
        if (!is_parallel()) {
            sight = p - origin;
            const float distance = length(sight);
            if (!(distance > 0)) return {};
            sight = sight / distance;
            w += spread * distance;
        }
        const float cosine = std::max(std::abs(dot(sight, n)), 1e-3f);
        Vec3 across = cross(n, sight);
        const float sine = length(across);
        // Seen head on, any direction will do.
        if (sine < 1e-4f) across = std::abs(n.x) > 0.5f ? cross(n, Vec3(0, 1, 0)) : cross(n, Vec3(1, 0, 0));
        across = across / std::max(length(across), 1e-20f);
        return {across * w, cross(n, across) * (w / cosine)};
    }
};

} // namespace alhazen
