/// Fields that are known in a part of space only, continued to all of it.
///
/// Outside a convex region, f(p) = sqrt(f(q)^2 + |p - q|^2) with q the nearest point of the region is
/// 1-Lipschitz if f is inside: p - q stands at right angles to all ways in which q can move.
#pragma once

#include "sdf/dual.h"

namespace alhazen {

template <class S>
S continued(S at_border, S distance) {
    return at_border > S(0.0) ? norm(at_border, distance) : distance;
}

/// inside(q) is known where x^2 + y^2 <= radius^2 and not negative on the border.
template <class S, class Inside>
S continue_beyond_cylinder(TVec3<S> p, double radius, const Inside& inside) {
    S rho = norm(p.x, p.y);
    if (rho <= S(radius)) return inside(p);
    S shrink = S(radius) / rho;
    return continued(inside(TVec3<S>{p.x * shrink, p.y * shrink, p.z}), rho - S(radius));
}

/// The same for a ball around the origin.
template <class S, class Inside>
S continue_beyond_ball(TVec3<S> p, double radius, const Inside& inside) {
    S rho = norm(p);
    if (rho <= S(radius)) return inside(p);
    return continued(inside(p * (S(radius) / rho)), rho - S(radius));
}

} // namespace alhazen
