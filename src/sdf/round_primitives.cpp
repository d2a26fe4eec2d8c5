/// Fields of round bodies: the distances to their surfaces, inside and outside.
#include <fmt/format.h>

#include "sdf/sdf.h"

namespace alhazen {

namespace {

struct SphereSdf final : SdfOf<SphereSdf> {
    float radius = 1;

    static void describe(Fields<SphereSdf>& f) {
        f.about("A sphere around the origin.");
        f.field("radius", &SphereSdf::radius, "radius").above(0);
        f.example("ball", {make_float("radius", 1)});
    }
    template <class S>
    S at(TVec3<S> p) const {
        return norm(p) - S(static_cast<double>(radius));
    }
    Box bounds() const override { return Box::around(Vec3d(static_cast<double>(radius))); }
};

struct TorusSdf final : SdfOf<TorusSdf> {
    float radius = 1, tube = 0.25f;

    static void describe(Fields<TorusSdf>& f) {
        f.about("A ring around the z axis.");
        f.field("radius", &TorusSdf::radius, "from the axis to the middle of the tube").above(0);
        f.field("tube", &TorusSdf::tube, "radius of the tube").above(0);
        f.example("ring", {make_float("radius", 1), make_float("tube", 0.3f)});
    }
    template <class S>
    S at(TVec3<S> p) const {
        return norm(norm(p.x, p.y) - S(static_cast<double>(radius)), p.z) - S(static_cast<double>(tube));
    }
    Box bounds() const override {
        double r = static_cast<double>(radius) + static_cast<double>(tube), t = static_cast<double>(tube);
        return Box::around({r, r, t});
    }
};

struct CapsuleSdf final : SdfOf<CapsuleSdf> {
    Vec3 p0{0, 0, -1}, p1{0, 0, 1};
    float radius = 0.5f;

    static void describe(Fields<CapsuleSdf>& f) {
        f.about("All points within a radius of a line segment: a cylinder with round ends.");
        f.field("p0", &CapsuleSdf::p0, "one end of the segment");
        f.field("p1", &CapsuleSdf::p1, "the other");
        f.field("radius", &CapsuleSdf::radius, "radius").above(0);
        f.example("pill", {make_point3("p0", {-0.5f, 0, 0}), make_point3("p1", {0.75f, 0.5f, 0.25f}),
                           make_float("radius", 0.3f)});
    }
    template <class S>
    S at(TVec3<S> p) const {
        TVec3<S> from(Vec3d(this->p0)), axis(Vec3d(p1) - Vec3d(p0)), v = p - from;
        double length2 = value_of(dot(axis, axis));
        S along(0.0);
        if (length2 > 0) along = std::clamp(dot(v, axis) / S(length2), S(0.0), S(1.0));
        return norm(v - axis * along) - S(static_cast<double>(radius));
    }
    Box bounds() const override {
        Box box{Vec3d(min(p0, p1)), Vec3d(max(p0, p1))};
        return box.grown(static_cast<double>(radius));
    }
};

/// Distances by the root of Eberly's equation ("Distance from a Point to an Ellipse, an Ellipsoid, or a
/// Hyperellipsoid", 2013): a convex falling function, on which Newton's method started at the left end
/// climbs towards the root and never past it.
struct EllipsoidSdf final : SdfOf<EllipsoidSdf> {
    Vec3 radii{1, 1, 1};

    static void describe(Fields<EllipsoidSdf>& f) {
        f.about("An ellipsoid around the origin.");
        f.field("radii", &EllipsoidSdf::radii, "half of its width along each axis").above(0);
        f.example("egg", {make_point3("radii", {0.5f, 0.75f, 1.25f})});
    }
    void finish(const Node& node, BuildContext& context) {
        if (radii.x > 0 && radii.y > 0 && radii.z > 0) return;
        context.messages.add_error(node.place,
                                   fmt::format("an ellipsoid's radii are {}, {} and {}; they must be above 0",
                                               radii.x, radii.y, radii.z));
    }
    template <class S>
    S at(TVec3<S> point) const {
        Vec3d p = values_of(point), r(radii), q = nearest(abs(p));
        Vec3d n = normalize(Vec3d{q.x / (r.x * r.x), q.y / (r.y * r.y), q.z / (r.z * r.z)});
        for (int i = 0; i < 3; ++i)
            if (p[i] < 0) {
                n[i] = -n[i];
                q[i] = -q[i];
            }
        return with_gradient(dot(p - q, n), n, point);
    }
    Box bounds() const override { return Box::around(Vec3d(radii)); }

  private:
    // The point of the surface nearest to p, whose coordinates are not negative.
    Vec3d nearest(Vec3d p) const {
        Vec3d r(radii);
        double least = std::min({r.x, r.y, r.z});
        // In the planes of symmetry inside, the equation loses its root; a hair beside them it does not.
        Vec3d z, g;
        double left = Box::far;
        for (int i = 0; i < 3; ++i) {
            z[i] = std::max(p[i] / least, 1e-14 * r[i] / least);
            g[i] = (r[i] / least) * (r[i] / least);
        }
        for (int i = 0; i < 3; ++i)
            if (r[i] == least) left = std::min(left, z[i]);
        // u = 1 + t / least^2; the nearest point is g z / (u + g - 1).
        double u = left;
        for (int step = 0; step < 200; ++step) {
            double value = -1, slope = 0;
            for (int i = 0; i < 3; ++i) {
                double below = u + (g[i] - 1), x = std::sqrt(g[i]) * z[i] / below;
                value += x * x;
                slope -= 2 * x * x / below;
            }
            double next = u - value / slope;
            if (!(next > u * (1 + 1e-15))) break;
            u = next;
        }
        Vec3d q;
        for (int i = 0; i < 3; ++i) q[i] = g[i] * z[i] * least / (u + (g[i] - 1));
        return q;
    }
};

} // namespace

Kind<Sdf> sphere_sdf() {
    return make_kind<Sdf, SphereSdf>("sphere");
}
Kind<Sdf> torus_sdf() {
    return make_kind<Sdf, TorusSdf>("torus");
}
Kind<Sdf> capsule_sdf() {
    return make_kind<Sdf, CapsuleSdf>("capsule");
}
Kind<Sdf> ellipsoid_sdf() {
    return make_kind<Sdf, EllipsoidSdf>("ellipsoid");
}

} // namespace alhazen
