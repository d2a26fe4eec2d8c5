/// The way back from the world to the film, for those who put surfaces onto pixels rather than send rays
/// through them.
#pragma once

#include "base/transform.h"

namespace alhazen {

/// How a camera that sees straight lines as straight lines maps the world.
struct Projection {
    /// Takes a world point to (x w, y w, depth, w): (x, y) is its place on the film, in pixels from the top
    /// left corner, depth its distance from the plane that rays start in; what has no positive depth is not
    /// seen.
    Matrix4 film_from_world;
    /// w is the depth; otherwise w is 1, and nothing gets smaller with distance.
    bool is_perspective = true;
};

} // namespace alhazen
