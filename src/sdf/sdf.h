/// Signed distance fields: surfaces given by how far away they are. Primitives and operators are nodes of an
/// expression tree (Hart 1996, "Sphere tracing"); Shape "sdf" shows one.
///
/// Within |f(p)| of p there is no surface. For all but fractals that is so because every node is divided by
/// its own Lipschitz bound: |f(p) - f(q)| <= |p - q|.
#pragma once

#include <memory>

#include "describe/kind.h"
#include "sdf/box.h"
#include "sdf/dual.h"

namespace alhazen {

struct Sdf {
    static constexpr std::string_view family_name = "sdf";
    virtual ~Sdf() = default;

    /// Negative inside, positive outside, at most the distance to the surface; in the node's own coordinates.
    /// Any thread may ask.
    virtual double value(Vec3d p) const = 0;
    /// The same with its gradient (of one of the sides where there is an edge).
    virtual Dual value(TVec3<Dual> p) const = 0;
    /// Around all that is inside; infinite where the inside is.
    virtual Box bounds() const = 0;
    /// Whether the field is 1-Lipschitz: what is made of one that is not is as if it were, in all but the
    /// shape of smooth seams.
    virtual bool is_lipschitz() const { return true; }
    /// Bound of the error that value(p) has beyond that of arithmetic in double precision.
    virtual double noise() const { return 0; }
};

/// A node T that is written once for both kinds of numbers:
///     template <class S> S at(TVec3<S> p) const;
template <class T>
struct SdfOf : Sdf {
    double value(Vec3d p) const final { return static_cast<const T*>(this)->at(p); }
    Dual value(TVec3<Dual> p) const final { return static_cast<const T*>(this)->at(p); }
};

const KindList<Sdf>& sdf_kinds();

} // namespace alhazen
