/// The open cylinder x^2 + y^2 = r^2 between two heights, perhaps only over an angle. u runs around the axis,
/// v along it; dpdu x dpdv points away from the axis.

#include <fmt/format.h>

#include "shapes/quadric.h"

namespace alhazen {

namespace {

struct Cylinder final : QuadricShape<Cylinder> {
    float radius = 1;
    float zmin = -1, zmax = 1;

    static void describe(Fields<Cylinder>& f) {
        f.about("A tube around the z axis, open at both ends.");
        f.field("radius", &Cylinder::radius, "radius").above(0);
        f.field("zmin", &Cylinder::zmin, "lower end");
        f.field("zmax", &Cylinder::zmax, "upper end");
        describe_sector(f);
        f.example("tube", {make_float("radius", 0.75f)});
        f.example("gutter", {make_float("radius", 1), make_float("zmin", 0.5f), make_float("zmax", 3),
                             make_float("phimax", 150)});
    }
    void finish(const Node& node, BuildContext& context) {
        if (zmin > zmax) std::swap(zmin, zmax);
        if (zmin == zmax)
            context.messages.add_error(
                node.place, fmt::format("zmin and zmax are both {}; they must be two heights", zmin));
        r_ = static_cast<double>(radius);
        z_min_ = static_cast<double>(zmin);
        z_max_ = static_cast<double>(zmax);
        finish_placement(node, context);
    }

    Bounds3 bounds(std::uint32_t) const override {
        Vec3d lo, hi;
        sector_box(r_, phi_max_, lo, hi);
        lo.z = z_min_;
        hi.z = z_max_;
        Bounds3 ends = placement.disk_bounds(r_, z_min_);
        ends.extend(placement.disk_bounds(r_, z_max_));
        return intersection_of(ends, placement.box_bounds(lo, hi));
    }

    Roots roots(const ObjectRay& r) const {
        Vec2d o{r.o.x, r.o.y}, d{r.d.x, r.d.y};
        double a = dot(d, d), h = dot(o, d), c = length(o);
        double miss = length(o - d * (h / a));
        return solve_quadratic(a, h, (c + r_) * (c - r_), a * (r_ + miss) * (r_ - miss));
    }
    Vec3d snap(Vec3d p) const {
        double scale = r_ / std::hypot(p.x, p.y);
        return {p.x * scale, p.y * scale, p.z};
    }
    bool covers(Vec3d p) const { return p.z >= z_min_ && p.z <= z_max_ && in_sector(p); }
    Vec3d outward(Vec3d p) const { return normalize(Vec3d{p.x, p.y, 0}); }
    ObjectTangents tangents(Vec3d p) const {
        double height = z_max_ - z_min_;
        return {{static_cast<float>(azimuth(p) / phi_max_), static_cast<float>((p.z - z_min_) / height)},
                Vec3d{-p.y, p.x, 0} * phi_max_,
                Vec3d{0, 0, height}};
    }
    Vec3d point_at(Vec2d u) const {
        double phi = phi_max_ * u.y;
        return {r_ * std::cos(phi), r_ * std::sin(phi), z_min_ + (z_max_ - z_min_) * u.x};
    }
    double object_area() const { return (z_max_ - z_min_) * r_ * phi_max_; }
    Vec3d at_parameters(double u, double v) const {
        const double phi = phi_max_ * u;
        return {r_ * std::cos(phi), r_ * std::sin(phi), std::lerp(z_min_, z_max_, v)};
    }
    Arcs arcs() const { return {r_, 0, 0}; }

  private:
    double r_ = 1, z_min_ = -1, z_max_ = 1;
};

} // namespace

Kind<Shape> cylinder_shape() {
    return make_kind<Shape, Cylinder>("cylinder");
}

} // namespace alhazen
