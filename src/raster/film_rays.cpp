#include "raster/film_rays.h"

namespace alhazen {

// Of a perspective projection the place on the film, times w, is linear in the point: of the point that is as
// far away as w = 1 says, it is the place itself. Of others the place and the depth are linear in the point.
FilmRays::FilmRays(const Projection& projection) : is_perspective_(projection.is_perspective) {
    const auto& m = projection.film_from_world.m;
    Matrix4 film_from_world;
    film_from_world.m = {m[0], m[1], is_perspective_ ? m[3] : m[2], {0, 0, 0, 1}};
    const Transform map(film_from_world);
    across_ = Vec3(map.inverse_vector(Vec3d{1, 0, 0}));
    down_ = Vec3(map.inverse_vector(Vec3d{0, 1, 0}));
    ahead_ = Vec3(map.inverse_vector(Vec3d{0, 0, 1}));
    start_ = Vec3(map.inverse_point(Vec3d{}));
}

} // namespace alhazen
