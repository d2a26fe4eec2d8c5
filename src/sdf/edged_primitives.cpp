/// Fields of bodies with edges: the distances to their surfaces, inside and outside.
#include <fmt/format.h>

#include "sdf/sdf.h"

namespace alhazen {

namespace {

// Distance to the box of these half widths.
template <class S>
S box_distance(TVec3<S> p, Vec3d half) {
    TVec3<S> q = absolute(p) - TVec3<S>(half), zero;
    TVec3<S> out = max(q, zero);
    return norm(out) + std::min(std::max(q.x, std::max(q.y, q.z)), S(0.0));
}

bool check_size(Vec3 size, const Node& node, BuildContext& context) {
    if (size.x > 0 && size.y > 0 && size.z > 0) return true;
    context.messages.add_error(
        node.place,
        fmt::format("a box's size is {}, {} and {}; expected three numbers above 0", size.x, size.y, size.z));
    return false;
}

struct BoxSdf final : SdfOf<BoxSdf> {
    Vec3 size{2, 2, 2};

    static void describe(Fields<BoxSdf>& f) {
        f.about("A box around the origin.");
        f.field("size", &BoxSdf::size, "width along each axis").above(0);
        f.example("brick", {make_point3("size", {2, 1, 0.5f})});
    }
    void finish(const Node& node, BuildContext& context) { check_size(size, node, context); }
    template <class S>
    S at(TVec3<S> p) const {
        return box_distance(p, Vec3d(size) * 0.5);
    }
    Box bounds() const override { return Box::around(Vec3d(size) * 0.5); }
};

struct RoundedBoxSdf final : SdfOf<RoundedBoxSdf> {
    Vec3 size{2, 2, 2};
    float radius = 0.25f;

    static void describe(Fields<RoundedBoxSdf>& f) {
        f.about("A box around the origin whose edges are rounded off.");
        f.field("size", &RoundedBoxSdf::size, "width along each axis, rounding included").above(0);
        f.field("radius", &RoundedBoxSdf::radius, "radius of the edges; at most half of the smallest width")
            .at_least(0);
        f.example("soap", {make_point3("size", {2, 1.5f, 1}), make_float("radius", 0.4f)});
    }
    void finish(const Node& node, BuildContext& context) {
        if (!check_size(size, node, context)) return;
        if (2 * radius <= std::min({size.x, size.y, size.z})) return;
        context.messages.add_error(node.place,
                                   fmt::format("edges of radius {} do not fit on a box of {} by {} by {}",
                                               radius, size.x, size.y, size.z));
    }
    template <class S>
    S at(TVec3<S> p) const {
        double r = static_cast<double>(radius);
        return box_distance(p, Vec3d(size) * 0.5 - Vec3d(r)) - S(r);
    }
    Box bounds() const override { return Box::around(Vec3d(size) * 0.5); }
};

struct CylinderSdf final : SdfOf<CylinderSdf> {
    float radius = 1, height = 2;

    static void describe(Fields<CylinderSdf>& f) {
        f.about("A solid cylinder around the z axis, with flat ends.");
        f.field("radius", &CylinderSdf::radius, "radius").above(0);
        f.field("height", &CylinderSdf::height, "length along z, half of it on each side of the origin")
            .above(0);
        f.example("coin", {make_float("radius", 1), make_float("height", 0.5f)});
    }
    template <class S>
    S at(TVec3<S> p) const {
        return quarter_plane_distance(norm(p.x, p.y) - S(static_cast<double>(radius)),
                                      absolute(p.z) - S(0.5 * static_cast<double>(height)));
    }
    Box bounds() const override {
        double r = static_cast<double>(radius);
        return Box::around({r, r, 0.5 * static_cast<double>(height)});
    }
};

struct ConeSdf final : SdfOf<ConeSdf> {
    float radius = 1, topradius = 0, height = 2;

    static void describe(Fields<ConeSdf>& f) {
        f.about("A solid cone around the z axis, or the lower part of one.");
        f.field("radius", &ConeSdf::radius, "at the base, z = -height / 2").above(0);
        f.field("topradius", &ConeSdf::topradius, "at z = height / 2").at_least(0);
        f.field("height", &ConeSdf::height, "length along z").above(0);
        f.example("hat", {make_float("radius", 1), make_float("height", 1.5f)});
        f.example("bucket",
                  {make_float("radius", 0.6f), make_float("topradius", 1), make_float("height", 1.25f)});
    }
    // In the half plane through the axis: the nearer of the slanted side and the two ends.
    template <class S>
    S at(TVec3<S> p) const {
        double r0 = static_cast<double>(radius), r1 = static_cast<double>(topradius);
        double h = 0.5 * static_cast<double>(height);
        S rho = norm(p.x, p.y);
        S beyond = rho - S(value_of(p.z) < 0 ? r0 : r1);
        // On the surface a norm has no gradient, a difference has.
        S above = absolute(p.z) - S(h);
        S end = beyond > S(0.0) ? norm(beyond, above) : absolute(above);
        double along_x = r1 - r0, along_z = 2 * h, length2 = along_x * along_x + along_z * along_z;
        S t =
            std::clamp(((rho - S(r0)) * S(along_x) + (p.z + S(h)) * S(along_z)) / S(length2), S(0.0), S(1.0));
        // Outside of the slanted side: on the side its normal (along_z, -along_x) points to.
        S over = ((rho - S(r0)) * S(along_z) - (p.z + S(h)) * S(along_x)) * S(1 / std::sqrt(length2));
        bool is_beside = value_of(t) > 0 && value_of(t) < 1;
        S side = is_beside ? absolute(over) : norm(rho - S(r0) - t * S(along_x), p.z + S(h) - t * S(along_z));
        bool is_inside = value_of(over) < 0 && std::abs(value_of(p.z)) < h;
        S least = std::min(end, side);
        return is_inside ? -least : least;
    }
    Box bounds() const override {
        double r = static_cast<double>(std::max(radius, topradius));
        return Box::around({r, r, 0.5 * static_cast<double>(height)});
    }
};

struct PlaneSdf final : SdfOf<PlaneSdf> {
    static void describe(Fields<PlaneSdf>& f) {
        f.about("All that is below the plane z = 0: for cutting other bodies, since it does not end.");
        f.example("ground", {});
    }
    template <class S>
    S at(TVec3<S> p) const {
        return p.z;
    }
    Box bounds() const override {
        Box box;
        box.hi.z = 0;
        return box;
    }
};

struct OctahedronSdf final : SdfOf<OctahedronSdf> {
    float radius = 1;

    static void describe(Fields<OctahedronSdf>& f) {
        f.about("A regular octahedron around the origin.");
        f.field("radius", &OctahedronSdf::radius, "from the centre to the corners").above(0);
        f.example("gem", {make_float("radius", 1)});
    }
    // In the first octant: the plane x + y + z = radius, over the triangle that the octant leaves of it.
    template <class S>
    S at(TVec3<S> p) const {
        double r = static_cast<double>(radius);
        TVec3<S> q = absolute(p);
        S over = (q.x + q.y + q.z - S(r)) / S(3.0);
        TVec3<S> foot = q - TVec3<S>(over);
        if (foot.x >= S(0.0) && foot.y >= S(0.0) && foot.z >= S(0.0)) return over * S(std::sqrt(3.0));
        // Only one coordinate of the foot can be the least: the edge lies opposite that axis.
        if (foot.y < foot.x && foot.y <= foot.z) std::swap(q.x, q.y);
        if (foot.z < foot.x && foot.z < foot.y) std::swap(q.x, q.z);
        S t = std::clamp((q.y - q.z + S(r)) / S(2 * r), S(0.0), S(1.0));
        TVec3<S> v{q.x, q.y - t * S(r), q.z - (S(1.0) - t) * S(r)};
        S d = norm(v);
        return over < S(0.0) ? -d : d;
    }
    Box bounds() const override { return Box::around(Vec3d(static_cast<double>(radius))); }
};

} // namespace

Kind<Sdf> box_sdf() {
    return make_kind<Sdf, BoxSdf>("box");
}
Kind<Sdf> roundedbox_sdf() {
    return make_kind<Sdf, RoundedBoxSdf>("roundedbox");
}
Kind<Sdf> cylinder_sdf() {
    return make_kind<Sdf, CylinderSdf>("cylinder");
}
Kind<Sdf> cone_sdf() {
    return make_kind<Sdf, ConeSdf>("cone");
}
Kind<Sdf> plane_sdf() {
    return make_kind<Sdf, PlaneSdf>("plane");
}
Kind<Sdf> octahedron_sdf() {
    return make_kind<Sdf, OctahedronSdf>("octahedron");
}

} // namespace alhazen
