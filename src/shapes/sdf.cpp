/// Surfaces of signed distance fields, met by sphere tracing in double precision.
#include <fmt/format.h>

#include "sdf/placed_sdf.h"
#include "sdf/tessellate.h"
#include "sdf/trace.h"
#include "shapes/placement.h"
#include "shapes/projected_uv.h"
#include "shapes/shape.h"
#include "shapes/triangle_points.h"

namespace alhazen {

namespace {

struct SdfShape final : Shape {
    SdfChild field;

    static void describe(Fields<SdfShape>& f) {
        f.about(
            "The surface of a signed distance field that Sdf directives describe. Its parameters u and v are "
            "two of the coordinates, over the longest side of its bounds: those across the direction that "
            "the surface faces most.");
        f.field("field", &SdfShape::field, "name of the sdf; it must end somewhere").required();
        describe_common(f);
        f.example("pebble", {make_string("field", "pebble")});
        f.example("pretzel", {make_string("field", "pretzel")});
    }
    void finish(const Node& node, BuildContext& context) {
        placement_.set(node, context);
        if (!field->bounds().is_bounded()) {
            context.messages.add_error(node.place_of("field"),
                                       "the sdf does not end; intersect it with a box or a sphere");
            return;
        }
        noise_ = field->noise();
        box_ = field->bounds();
        extent_ = max_component(box_.size());
        box_ = box_.grown(1e-9 * extent_ + noise_);
    }

    Bounds3 bounds(std::uint32_t) const override {
        if (box_.is_empty()) return {};
        return placement_.box_bounds(box_.lo, box_.hi);
    }

    bool intersect(const Ray& ray, std::uint32_t, Intersection& hit) const override {
        if (!is_finite(ray.o) || !is_finite(ray.d) || !(ray.tmax > 0) || box_.is_empty()) return false;
        ObjectRay r = placement_.to_object(ray);
        double speed = length(r.d);
        if (!(speed > 0)) return false;
        Vec3d d = r.d * (1 / speed);
        auto line = clip(r.o, d);
        // The nearest distance that may still round to below tmax.
        line.end = std::min(line.end, static_cast<double>(next_up(ray.tmax)) * speed);
        if (!(line.begin <= line.end)) return false;
        auto s = first_crossing([&](double at) { return field->value(r.o + d * at); }, line,
                                length(r.o) + extent_);
        if (!s) return false;
        double exact = *s / speed;
        auto t = static_cast<float>(exact);
        if (!(t > 0) || !(t < ray.tmax)) return false;
        hit.t = t;
        // What the rounding of t takes away, so that surface() need not trace again.
        hit.u = static_cast<float>(exact - static_cast<double>(t));
        hit.v = 0;
        return true;
    }

    Hit surface(const Ray& ray, std::uint32_t primitive, const Intersection& met) const override {
        ObjectRay r = placement_.to_object(ray);
        double t = static_cast<double>(met.t) + static_cast<double>(met.u);
        Vec3d p = r.at(t);
        Local local = local_at(p, normalize(-r.d));
        Hit hit;
        hit.p = Vec3(placement_.point(p));
        hit.p_error = placement_.point_error(p) + error_of(local) +
                      Vec3((abs(Vec3d(ray.o)) + abs(Vec3d(ray.d)) * t) * 4e-15);
        hit.wo = Vec3(normalize(Vec3d(-ray.d)));
        hit.ng = hit.ns = placement_.normal(local.n);
        hit.dpdu = Vec3(placement_.vector(local.uv.dpdu));
        hit.dpdv = Vec3(placement_.vector(local.uv.dpdv));
        hit.uv = local.uv.uv;
        hit.t = met.t;
        hit.time = ray.time;
        hit.primitive = primitive;
        return hit;
    }

    // Sharp edges are cut off by up to a cell.
    bool tessellate(double tolerance, const TriangleSink& out) const override {
        // A cell's triangles are much nearer to a surface that is smooth: by the square of the cell.
        constexpr double cells_in_tolerance = 0.125;
        constexpr int fewest = 4, most = 9;
        if (box_.is_empty()) return true;
        const double cells = extent_ * placement_.largest_stretch() * cells_in_tolerance / tolerance;
        const int levels = std::clamp(static_cast<int>(std::ceil(std::log2(cells))), fewest, most);
        for (const SdfTriangle& t : tessellate_field(levels)) out(facing(t));
        return true;
    }

    float area(std::uint32_t) const override { return points().area(); }
    std::size_t bytes() const override { return sizeof *this; }
    ShapeSample sample(std::uint32_t, Vec2 u) const override {
        auto p = points().at(u);
        if (!p) return {};
        Vec3d on_surface = move_to_surface(*field.node, *p, extent_ / 16);
        Local local = local_at(on_surface, {0, 0, 1});
        return {Vec3(placement_.point(on_surface)), placement_.point_error(on_surface) + error_of(local),
                placement_.normal(local.n), local.uv.uv, 1 / points().area()};
    }

  private:
    /// The surface around a point of it, in object space.
    struct Local {
        Vec3d n;
        double steepness = 0;
        ProjectedUv uv;
    };

    std::vector<SdfTriangle> tessellate_field(int levels) const {
        return alhazen::tessellate(*field.node, levels);
    }
    // With its corners round the side where the field grows.
    Corners facing(const SdfTriangle& t) const {
        const auto& [a, b, c] = t;
        const Vec3d out = field->value(dual_point((a + b + c) * (1.0 / 3))).d;
        const bool is_outward = dot(cross(b - a, c - a), out) >= 0;
        return is_outward ? placement_.triangle(a, b, c) : placement_.triangle(a, c, b);
    }

    // Where the line is within the box.
    SphereTrace clip(Vec3d o, Vec3d d) const {
        SphereTrace line{0, Box::far, extent_ * 0x1p-20};
        for (int i = 0; i < 3; ++i) {
            if (d[i] == 0) {
                if (o[i] < box_.lo[i] || o[i] > box_.hi[i]) line.end = -1;
                continue;
            }
            double a = (box_.lo[i] - o[i]) / d[i], b = (box_.hi[i] - o[i]) / d[i];
            line.begin = std::max(line.begin, std::min(a, b));
            line.end = std::min(line.end, std::max(a, b));
        }
        return line;
    }

    // Where the field has no gradient, the surface is taken to face the given way.
    Local local_at(Vec3d p, Vec3d otherwise) const {
        Local local;
        Vec3d g = field->value(dual_point(p)).d;
        local.steepness = length(g);
        local.n = local.steepness > 1e-9 ? g * (1 / local.steepness) : otherwise;
        local.uv = project_uv(p, local.n, box_);
        return local;
    }
    // What the field's own noise may move the surface by.
    Vec3 error_of(const Local& local) const {
        if (noise_ == 0) return {};
        return Vec3(abs(placement_.vector(local.n * (4 * noise_ / std::max(local.steepness, 0.05)))));
    }
    const TrianglePoints& points() const {
        constexpr int levels = 7;
        return points_.get([this] {
            std::vector<SdfTriangle> triangles;
            if (!box_.is_empty()) triangles = tessellate_field(levels);
            return TrianglePoints(std::move(triangles), [this](Vec3d p) { return placement_.point(p); });
        });
    }

    Placement placement_;
    Box box_;
    double extent_ = 1, noise_ = 0;
    OnDemand<TrianglePoints> points_;
};

} // namespace

Kind<Shape> sdf_shape() {
    return make_kind<Shape, SdfShape>("sdf");
}

} // namespace alhazen
