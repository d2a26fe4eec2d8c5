/// One cubic piece of a strand, and where rays meet it: hair, fur, grass, thread. Seen along a ray, a strand
/// is a flat band around the projected curve, as wide as the strand is there (Nakamaru and Ohno 2002, "Ray
/// tracing for curves primitive"; Pharr et al. 2023, section 6.7). What it looks like is decided by the type:
/// a band that always faces the ray, the same with the normals of a tube, or a ribbon with normals of its
/// own.
#pragma once

#include "accel/intersection.h"
#include "base/ray.h"
#include "shapes/bezier.h"

namespace alhazen {

enum class CurveType { flat, cylinder, ribbon };

/// All in one space, the object's, whose rays' directions need not have unit length.
struct CurveSegment {
    CubicBezier points;
    float width0 = 1, width1 = 1; ///< at u = 0 and 1, linear between
    Vec3 normal0, normal1;        ///< ribbons: unit normals there

    float width(float u) const { return lerp(u, width0, width1); }
    /// A ribbon's unit normal, turning evenly from the one to the other.
    Vec3 ribbon_normal(float u) const;
    /// Width of the band as the ray sees it, direction being unit length.
    float seen_width(CurveType type, float u, Vec3 direction) const;

    /// The nearest hit at 0 < t < ray.tmax with u in [u0, u1]: sets hit's t, u along the strand and v across
    /// it (0 to 1).
    bool intersect(const Ray& ray, CurveType type, float u0, float u1, Intersection& hit) const;

    struct Tangents {
        Vec3 dpdu, dpdv;
    };
    /// Of a hit.
    Tangents tangents(const Ray& ray, CurveType type, float u, float v) const;
};

} // namespace alhazen
