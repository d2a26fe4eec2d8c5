/// One bilinear patch: the surface that a straight line sweeps when its ends slide along two other lines.
/// Picture a rectangle of cloth with its four corners pinned anywhere. All in double precision.
#pragma once

#include <array>

#include "base/vec.h"

namespace alhazen {

struct BilinearPatch {
    /// Corners at (u, v) = (0,0), (1,0), (0,1), (1,1).
    Vec3d p00, p10, p01, p11;

    Vec3d at(double u, double v) const { return start(u) + sweep(u) * v; }
    Vec3d dpdu(double v) const { return (p10 - p00) * (1 - v) + (p11 - p01) * v; }
    Vec3d dpdv(double u) const { return sweep(u); }
    /// dpdu x dpdv, whose length is area per area of parameters. It is linear in u and v, since the terms in
    /// u v are a vector crossed with itself.
    Vec3d area_vector(double u, double v) const { return cross(dpdu(v), dpdv(u)); }
    /// Unit normal along dpdu x dpdv; where that vanishes (a corner of a patch with two equal corners), its
    /// limit from inside.
    Vec3d normal(double u, double v) const;
    /// Into how many strips each way it must be cut so that two triangles in place of each piece stay within
    /// tolerance of it; 1 where it is flat.
    int cuts(double tolerance) const;
    /// Numerically, to about seven digits for patches that are not folded.
    double area() const;

    struct Hit {
        double t, u, v;
    };
    /// The nearest hit at 0 < t < tmax; false when there is none.
    bool intersect(Vec3d o, Vec3d d, double tmax, Hit& hit) const;

  private:
    Vec3d start(double u) const { return p00 * (1 - u) + p10 * u; }
    Vec3d sweep(double u) const { return (p01 - p00) * (1 - u) + (p11 - p10) * u; }
    bool hit_on_line(Vec3d o, Vec3d d, double u, double tmax, Hit& hit) const;
};

} // namespace alhazen
