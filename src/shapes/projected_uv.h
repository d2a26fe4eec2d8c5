/// Parameters for surfaces that have none of their own: two of the coordinates, those across the axis that
/// the normal is nearest to.
#pragma once

#include "base/vec.h"
#include "sdf/box.h"

namespace alhazen {

struct ProjectedUv {
    Vec2 uv;
    Vec3d dpdu, dpdv; ///< dpdu x dpdv is on the side of the normal
};

/// p with unit normal n on a surface within the box; u and v are 0 to 1 over its longest side.
inline ProjectedUv project_uv(Vec3d p, Vec3d n, const Box& box) {
    double extent = max_component(box.size());
    int k = max_dimension(abs(n)), i = (k + 1) % 3, j = (k + 2) % 3;
    double along = n[k] < 0 ? -extent : extent;
    ProjectedUv out;
    out.dpdu[i] = along;
    out.dpdu[k] = -along * n[i] / n[k];
    out.dpdv[j] = extent;
    out.dpdv[k] = -extent * n[j] / n[k];
    Vec3d from = along > 0 ? p - box.lo : box.hi - p;
    out.uv = {static_cast<float>(from[i] / extent), static_cast<float>((p[j] - box.lo[j]) / extent)};
    return out;
}

} // namespace alhazen
