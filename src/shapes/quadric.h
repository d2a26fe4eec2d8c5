/// What sphere, disk and cylinder have in common: a surface given by an equation, cut out by limits of height
/// and angle, met by solving the equation in double precision in object space.
#pragma once

#include <array>
#include <bit>

#include "base/hash.h"
#include "shapes/placement.h"
#include "shapes/shape.h"

namespace alhazen {

/// Where a ray meets the whole, uncut surface: in ascending order.
struct Roots {
    std::array<double, 2> t{};
    int count = 0;
};

/// The roots of a t^2 + 2 h t + c with discriminant h^2 - a c given apart, since each surface knows a form of
/// it without cancellation; none when they are not real (or NaN).
inline Roots solve_quadratic(double a, double h, double c, double discriminant) {
    if (!(discriminant >= 0) || !(a > 0)) return {};
    double q = h < 0 ? -h + std::sqrt(discriminant) : -h - std::sqrt(discriminant);
    double t0 = q / a, t1 = q != 0 ? c / q : 0;
    return {{std::min(t0, t1), std::max(t0, t1)}, 2};
}

/// A quadric's parameters and tangents at a point, in object space.
struct ObjectTangents {
    Vec2 uv;
    Vec3d dpdu, dpdv;
};

/// Angle around the z axis, 0 ... 2 pi.
template <class T>
T azimuth(TVec3<T> p) {
    T phi = std::atan2(p.y, p.x);
    return phi < 0 ? phi + static_cast<T>(2 * 3.14159265358979323846) : phi;
}
inline double to_radians(float degrees) {
    return static_cast<double>(degrees) * (3.14159265358979323846 / 180);
}

/// The circles that a surface runs along.
struct Arcs {
    double around = 0;           ///< largest radius of those around the axis
    double radius = 0, bend = 0; ///< of the one from v = 0 to 1, and the angle of it; 0: a straight line
};

/// Q is the quadric (which derives from this) and provides, in object space:
///     Roots roots(const ObjectRay&) const;
///     Vec3d snap(Vec3d p) const;                  the surface's point nearest to p, which is within rounding
///     of it bool covers(Vec3d p) const;                 whether a point of the surface is within the limits
///     Vec3d outward(Vec3d p) const;               unit normal, along dpdu x dpdv
///     ObjectTangents tangents(Vec3d p) const;
///     Vec3d point_at(Vec2d u) const;              uniform over the area within the limits
///     double object_area() const;
///     Vec3d at_parameters(double u, double v) const;
///     Arcs arcs() const;
template <class Q>
struct QuadricShape : Shape {
    float phimax = 360;

    bool intersect(const Ray& ray, std::uint32_t /*primitive*/, Intersection& hit) const override {
        ObjectRay r = placement.to_object(ray);
        Roots roots = self().roots(r);
        for (int i = 0; i < roots.count; ++i) {
            double exact = roots.t[static_cast<std::size_t>(i)];
            auto t = static_cast<float>(exact);
            if (!(t > 0) || !(t < ray.tmax) || !self().covers(self().snap(r.at(exact)))) continue;
            hit.t = t;
            hit.u = hit.v = 0;
            return true;
        }
        return false;
    }

    Hit surface(const Ray& ray, std::uint32_t primitive, const Intersection& met) const override {
        ObjectRay r = placement.to_object(ray);
        Vec3d p = self().snap(r.at(exact_distance(r, static_cast<double>(met.t))));
        ObjectTangents tangents = self().tangents(p);
        Hit hit;
        hit.p = Vec3(placement.point(p));
        hit.p_error = placement.point_error(p);
        hit.wo = Vec3(normalize(Vec3d(-ray.d)));
        hit.ng = hit.ns = placement.normal(self().outward(p));
        hit.dpdu = Vec3(placement.vector(tangents.dpdu));
        hit.dpdv = Vec3(placement.vector(tangents.dpdv));
        hit.uv = tangents.uv;
        hit.t = met.t;
        hit.time = ray.time;
        hit.primitive = primitive;
        return hit;
    }

    // By differences: the steps are small beside the surface, and large beside a float's rounding of normals.
    NormalChange normal_change(const Hit& hit) const final {
        const Vec3d p = self().snap(placement.to_object(hit.p));
        const ObjectTangents tangents = self().tangents(p);
        auto change = [&](Vec3d tangent) {
            constexpr double step = 0.01;
            const Vec3d ahead = self().snap(p + tangent * step), behind = self().snap(p - tangent * step);
            const Vec3 d = placement.normal(self().outward(ahead)) - placement.normal(self().outward(behind));
            return d / static_cast<float>(2 * step);
        };
        return {change(tangents.dpdu), change(tangents.dpdv)};
    }

    bool tessellate(double tolerance, const TriangleSink& out) const final {
        // The two arcs' errors add up.
        const double allowed = 0.5 * tolerance / placement.largest_stretch();
        const Arcs arcs = self().arcs();
        const int around = chords(arcs.around, phi_max_, allowed),
                  along = chords(arcs.radius, arcs.bend, allowed);
        const bool is_closed = phimax >= 360;
        auto at = [&](int i, int j) {
            if (is_closed && i == around) i = 0;
            return self().at_parameters(static_cast<double>(i) / around, static_cast<double>(j) / along);
        };
        for (int j = 0; j < along; ++j)
            for (int i = 0; i < around; ++i) {
                const Vec3d a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
                out(placement.triangle(a, b, c));
                out(placement.triangle(a, c, d));
            }
        return true;
    }

    float area(std::uint32_t /*primitive*/) const final { return static_cast<float>(world_area_); }
    std::size_t bytes() const final { return sizeof(Q); }

    ShapeSample sample(std::uint32_t /*primitive*/, Vec2 u) const final {
        Vec3d p = self().point_at(Vec2d(u));
        if (!is_even_) p = thin_out(u, p);
        return sample_at(p, area_pdf());
    }

  protected:
    template <class T>
    static void describe_sector(Fields<T>& f) {
        f.field("phimax", &T::phimax, "angle around the z axis that is kept")
            .in(0, 360)
            .above(0)
            .unit("degrees");
        describe_common(f);
    }
    /// To be called last in finish().
    void finish_placement(const Node& node, const BuildContext& context) {
        phi_max_ = to_radians(phimax);
        placement.set(node, context);
        measure();
    }
    ShapeSample sample_at(Vec3d p, float pdf) const {
        return {Vec3(placement.point(p)), placement.point_error(p), placement.normal(self().outward(p)),
                self().tangents(p).uv, pdf};
    }
    float area_pdf() const { return static_cast<float>(1 / world_area_); }
    bool in_sector(Vec3d p) const { return phimax >= 360 || azimuth(p) <= phi_max_; }

    Placement placement;
    double phi_max_ = 0; ///< phimax in radians

  private:
    const Q& self() const { return static_cast<const Q&>(*this); }

    // How many chords stay within the distance of an arc.
    static int chords(double radius, double angle, double allowed) {
        constexpr double widest = 0.25 * 3.14159265358979323846;
        constexpr double most = 1 << 14;
        const double step = allowed < radius ? std::min(2 * std::acos(1 - allowed / radius), widest) : widest;
        return static_cast<int>(std::clamp(std::ceil(angle / step), 1.0, most));
    }

    // The root that met.t is the rounded value of.
    double exact_distance(const ObjectRay& r, double t) const {
        Roots roots = self().roots(r);
        double nearest = t, gap = static_cast<double>(infinity);
        for (int i = 0; i < roots.count; ++i) {
            double root = roots.t[static_cast<std::size_t>(i)];
            if (std::abs(root - t) < gap) {
                gap = std::abs(root - t);
                nearest = root;
            }
        }
        return nearest;
    }

    // Area, and how unevenly a transformation that is no similarity stretches it. The mean is taken over a
    // grid of equal areas: spectrally accurate around the axis, second order along it.
    void measure() {
        constexpr int along = 256, around = 32;
        world_area_ = self().object_area() * placement.stretch(self().outward(self().point_at({0.5, 0.5})));
        is_even_ = true;
        if (placement.is_similarity()) return;
        double sum = 0, least = static_cast<double>(infinity);
        max_stretch_ = 0;
        for (int i = 0; i < along; ++i)
            for (int j = 0; j < around; ++j) {
                Vec3d p = self().point_at({(i + 0.5) / along, (j + 0.5) / around});
                double stretch = placement.stretch(self().outward(p));
                sum += stretch;
                least = std::min(least, stretch);
                max_stretch_ = std::max(max_stretch_, stretch);
            }
        world_area_ = self().object_area() * sum / (along * around);
        is_even_ = max_stretch_ - least < 1e-6 * max_stretch_;
    }

    // Points uniform in object space are kept in proportion to how much the surface is stretched there: what
    // is left is uniform in the world. The further numbers are drawn from u, so that the same u gives the
    // same point.
    Vec3d thin_out(Vec2 u, Vec3d p) const {
        constexpr int most_tries = 256;
        Rng rng(hash_of(std::bit_cast<std::uint32_t>(u.x), std::bit_cast<std::uint32_t>(u.y)));
        for (int i = 0; i < most_tries; ++i) {
            double keep = placement.stretch(self().outward(p)) / max_stretch_;
            if (static_cast<double>(rng.uniform()) < keep) return p;
            p = self().point_at({static_cast<double>(rng.uniform()), static_cast<double>(rng.uniform())});
        }
        return p;
    }

    double world_area_ = 0, max_stretch_ = 0;
    bool is_even_ = true;
};

} // namespace alhazen
