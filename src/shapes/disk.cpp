/// The disk z = height, x^2 + y^2 <= r^2, perhaps with a hole and only over an angle. u runs around the axis,
/// v from the rim to the hole; the normal is +z.

#include <fmt/format.h>

#include "math/warp.h"
#include "shapes/quadric.h"

namespace alhazen {

namespace {

struct Disk final : QuadricShape<Disk> {
    float height = 0;
    float radius = 1;
    float innerradius = 0;

    static void describe(Fields<Disk>& f) {
        f.about("A flat disk across the z axis, or a ring, or a sector of either.");
        f.field("height", &Disk::height, "where it cuts the z axis");
        f.field("radius", &Disk::radius, "radius").above(0);
        f.field("innerradius", &Disk::innerradius, "radius of the hole").at_least(0);
        describe_sector(f);
        f.example("plate", {make_float("radius", 1)});
        f.example("ring sector", {make_float("height", 0.5f), make_float("radius", 2),
                                  make_float("innerradius", 0.75f), make_float("phimax", 230)});
    }
    void finish(const Node& node, BuildContext& context) {
        if (innerradius >= radius)
            context.messages.add_error(
                node.place,
                fmt::format("innerradius is {}; it must be less than radius, {}", innerradius, radius));
        z_ = static_cast<double>(height);
        r_ = static_cast<double>(radius);
        hole_ = static_cast<double>(innerradius);
        finish_placement(node, context);
    }

    Bounds3 bounds(std::uint32_t) const override {
        Vec3d lo, hi;
        sector_box(r_, phi_max_, lo, hi);
        lo.z = hi.z = z_;
        return intersection_of(placement.disk_bounds(r_, z_), placement.box_bounds(lo, hi));
    }
    NormalCone normals(std::uint32_t) const override { return {placement.normal({0, 0, 1}), 1}; }

    Roots roots(const ObjectRay& r) const {
        if (r.d.z == 0) return {};
        return {{(z_ - r.o.z) / r.d.z}, 1};
    }
    Vec3d snap(Vec3d p) const { return {p.x, p.y, z_}; }
    bool covers(Vec3d p) const {
        double r2 = p.x * p.x + p.y * p.y;
        return r2 <= r_ * r_ && r2 >= hole_ * hole_ && in_sector(p);
    }
    Vec3d outward(Vec3d) const { return {0, 0, 1}; }
    ObjectTangents tangents(Vec3d p) const {
        // In the middle the angle is arbitrary: just beside it all is defined.
        if (p.x == 0 && p.y == 0) p.x = 1e-6 * r_;
        double across = std::hypot(p.x, p.y);
        return {{static_cast<float>(azimuth(p) / phi_max_), static_cast<float>((r_ - across) / (r_ - hole_))},
                Vec3d{-p.y, p.x, 0} * phi_max_,
                Vec3d{p.x, p.y, 0} * ((hole_ - r_) / across)};
    }
    Vec3d point_at(Vec2d u) const {
        if (hole_ == 0 && phimax >= 360) {
            Vec2 d = sample_disk(Vec2(u));
            return {r_ * static_cast<double>(d.x), r_ * static_cast<double>(d.y), z_};
        }
        double across = std::sqrt(hole_ * hole_ + (r_ * r_ - hole_ * hole_) * u.x), phi = phi_max_ * u.y;
        return {across * std::cos(phi), across * std::sin(phi), z_};
    }
    double object_area() const { return phi_max_ * 0.5 * (r_ * r_ - hole_ * hole_); }
    Vec3d at_parameters(double u, double v) const {
        const double phi = phi_max_ * u, across = std::lerp(r_, hole_, v);
        return {across * std::cos(phi), across * std::sin(phi), z_};
    }
    Arcs arcs() const { return {r_, 0, 0}; }

  private:
    double z_ = 0, r_ = 1, hole_ = 0;
};

} // namespace

Kind<Shape> disk_shape() {
    return make_kind<Shape, Disk>("disk");
}

} // namespace alhazen
