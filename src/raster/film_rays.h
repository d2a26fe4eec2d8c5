/// The rays of a projection, before they are of unit length: what is left to do for a pixel is a few
/// additions.
#pragma once

#include "cameras/projection.h"
#include "raster/kernel.h"

namespace alhazen {

class FilmRays {
  public:
    explicit FilmRays(const Projection& projection);

    /// Where the ray through a place on the film starts.
    Vec3 origin(Vec2 film) const {
        return is_perspective_ ? start_ : start_ + across_ * film.x + down_ * film.y;
    }
    /// Not of unit length.
    Vec3 direction(Vec2 film) const {
        return is_perspective_ ? ahead_ + across_ * film.x + down_ * film.y : ahead_;
    }

    /// How many directions away from the origin a surface is that is so near (see DrawnTile::nearness).
    float steps(float nearness) const { return is_perspective_ ? 1 / nearness : -nearness; }

    /// For RasterKernel::place.
    RasterRays numbers() const {
        return {{start_.x, start_.y, start_.z},
                {ahead_.x, ahead_.y, ahead_.z},
                {across_.x, across_.y, across_.z},
                {down_.x, down_.y, down_.z},
                is_perspective_};
    }

  private:
    bool is_perspective_;
    Vec3 start_, ahead_, across_, down_;
};

} // namespace alhazen
