/// Strands: hair, fur, grass. A directive gives one strand of one or more cubic segments; each is cut into
/// parts, the primitives, whose boxes are tighter than that of the whole.
#include <fmt/format.h>

#include "shapes/curve_segment.h"
#include "shapes/mesh_arrays.h"
#include "shapes/placement.h"
#include "shapes/shape.h"

namespace alhazen {

namespace {

enum class CurveBasis { bezier, bspline };

} // namespace

template <>
struct EnumNames<CurveType> {
    static constexpr std::array names{"flat", "cylinder", "ribbon"};
};
template <>
struct EnumNames<CurveBasis> {
    static constexpr std::array names{"bezier", "bspline"};
};

namespace {

struct Curve final : Shape {
    std::vector<Vec3> P, N;
    CurveType type = CurveType::flat;
    CurveBasis basis = CurveBasis::bezier;
    int degree = 3;
    float width = 1;
    std::optional<float> width0, width1;
    int splitdepth = 3;

    static void describe(Fields<Curve>& f) {
        f.about("A strand of hair, grass or thread along a spline. u runs along each of its segments, v "
                "across. It "
                "cannot be an area light.");
        f.field(
             "P", &Curve::P,
             "control points; for basis bezier, each segment after the first adds as many as the degree, for "
             "bspline one")
            .required();
        f.field("basis", &Curve::basis, "what kind of spline the points control");
        f.field("degree", &Curve::degree, "2 or 3").in(2, 3);
        f.field("type", &Curve::type,
                "a band that faces every ray; the same with the normals of a tube; or a ribbon that lies "
                "across N");
        f.field("N", &Curve::N, "ribbons: normals, one at each end of each segment");
        f.field("width", &Curve::width, "width of the strand").at_least(0).unit("scene units");
        f.field("width0", &Curve::width0, "width at the start")
            .at_least(0)
            .unit("scene units")
            .otherwise("width");
        f.field("width1", &Curve::width1, "width at the end")
            .at_least(0)
            .unit("scene units")
            .otherwise("width");
        f.field("splitdepth", &Curve::splitdepth,
                "each segment becomes up to 2 to this power primitives; fewer where these would be hardly "
                "longer than "
                "wide")
            .in(0, 10);
        describe_common(f);
        const std::vector<Vec3> wave{{-1, 0, 0}, {-0.5f, 1, 0.3f}, {0.4f, -1, -0.2f}, {1, 0.2f, 0.5f}};
        const std::vector<Vec3> hook{
            {-1, 0, 0}, {-0.4f, 0.8f, 0.1f}, {0.3f, 0.4f, -0.5f}, {0.2f, -0.5f, 0.4f}, {1, -0.6f, 0}};
        f.example("hair", {make_array("P", ValueType::point3, wave), make_float("width0", 0.5f),
                           make_float("width1", 0.2f)});
        f.example("thread", {make_array("P", ValueType::point3, hook), make_string("basis", "bspline"),
                             make_string("type", "cylinder"), make_float("width", 0.1f)});
        f.example("arc", {make_array("P", ValueType::point3, hook), make_integer("degree", 2),
                          make_float("width", 0.25f), make_integer("splitdepth", 1)});
        f.example("arcs", {make_array("P", ValueType::point3, hook), make_integer("degree", 2),
                           make_string("basis", "bspline"), make_float("width", 0.2f),
                           make_string("type", "cylinder"), make_integer("splitdepth", 0)});
        f.example("blade", {make_array("P", ValueType::point3, wave), make_string("type", "ribbon"),
                            make_array<Vec3>("N", ValueType::normal, {{0, 0, 1}, {0, 1, 0.5f}}),
                            make_float("width", 0.8f)});
    }

    void finish(const Node& node, BuildContext& context);

    std::uint32_t primitive_count() const override {
        return static_cast<std::uint32_t>(segments_.size()) * parts();
    }
    Bounds3 bounds(std::uint32_t primitive) const override;
    bool intersect(const Ray& ray, std::uint32_t primitive, Intersection& hit) const override {
        const Part part = part_of(primitive);
        return part.segment.intersect(into_object(ray), type, part.u0, part.u1, hit);
    }
    Hit surface(const Ray& ray, std::uint32_t primitive, const Intersection& met) const override;

    bool can_be_light() const override { return false; }
    float area(std::uint32_t primitive) const override;
    ShapeSample sample(std::uint32_t, Vec2) const override { return {}; }
    std::size_t bytes() const override { return sizeof *this + segments_.capacity() * sizeof(CurveSegment); }

  private:
    struct Part {
        const CurveSegment& segment;
        float u0, u1;
    };
    std::uint32_t parts() const { return 1u << depth_; }
    Part part_of(std::uint32_t primitive) const {
        const float size = 1 / static_cast<float>(parts());
        const auto i = static_cast<float>(primitive & (parts() - 1));
        return {segments_[primitive >> depth_], i * size, (i + 1) * size};
    }
    Ray into_object(const Ray& ray) const { return is_in_world_ ? ray : world_from_object_.inverse_ray(ray); }

    void check_points(const Node& node, BuildContext& context) const;
    void check_normals(const Node& node, BuildContext& context);
    void make_segments();
    int useful_depth() const;
    void place(const Transform& world_from_object, bool is_similarity, bool reverse);
    CubicBezier points_of(std::size_t segment) const;
    std::size_t segment_count() const {
        const auto d = static_cast<std::size_t>(degree);
        return basis == CurveBasis::bezier ? (P.size() - 1) / d : P.size() - d;
    }

    int depth_ = 0;                      ///< each segment is 2 to this power primitives
    std::vector<CurveSegment> segments_; ///< in the world if is_in_world_, else in object space
    bool is_in_world_ = false;
    Transform world_from_object_; ///< of the segments: the identity when they are in the world
    bool is_turned_ = false;      ///< normals point against the parameterisation
    /// Half sides of the world's boxes around the object's unit ball, and around a cube of half side 1.
    Vec3 ball_extent_{1, 1, 1}, cube_extent_{1, 1, 1};
};

void Curve::finish(const Node& node, BuildContext& context) {
    const std::size_t errors = context.messages.error_count();
    check_points(node, context);
    if (context.messages.error_count() == errors) check_normals(node, context);
    Placement placement;
    placement.set(node, context);
    if (context.messages.error_count() != errors) return;
    make_segments();
    place(context.world_from_node, placement.is_similarity(), context.reverse_orientation);
    P = {};
    N = {};
}

void Curve::check_points(const Node& node, BuildContext& context) const {
    const MeshChecks checks{context.messages, node.find("P")->place, ""};
    checks.finite("P", P);
    const auto d = static_cast<std::size_t>(degree);
    if (basis == CurveBasis::bezier && (P.size() < d + 1 || (P.size() - 1) % d != 0))
        checks.error(
            fmt::format("parameter \"P\" has {} points; a curve of Bezier basis and degree {} must have {}, "
                        "{}, {} ...",
                        P.size(), d, d + 1, 2 * d + 1, 3 * d + 1));
    if (basis == CurveBasis::bspline && P.size() < d + 1)
        checks.error(
            fmt::format("parameter \"P\" has {} points; a B-spline of degree {} must have at least {}",
                        P.size(), d, d + 1));
}

void Curve::check_normals(const Node& node, BuildContext& context) {
    const Parameter* given = node.find("N");
    if (type != CurveType::ribbon) {
        if (given)
            context.messages.add_warning(given->place,
                                         "parameter \"N\" has no effect: only ribbons have normals");
        return;
    }
    const std::size_t needed = segment_count() + 1;
    const MeshChecks checks{context.messages, node.place_of("N"), ""};
    if (N.size() != needed)
        return checks.error(fmt::format(
            "this ribbon of {} segments must have {} normals \"N\", one at each end of each; it has {}",
            needed - 1, needed, N.size()));
    for (const Vec3& n : N)
        if (!is_finite(n) || !(length_squared(n) > 0))
            return checks.error("parameter \"N\" has a normal that is zero or not finite");
}

CubicBezier Curve::points_of(std::size_t segment) const {
    if (basis == CurveBasis::bezier) {
        const Vec3* p = &P[segment * static_cast<std::size_t>(degree)];
        return degree == 2 ? cubic_of_quadratic_bezier(p[0], p[1], p[2])
                           : CubicBezier{p[0], p[1], p[2], p[3]};
    }
    const Vec3* p = &P[segment];
    return degree == 2 ? cubic_of_quadratic_spline(p[0], p[1], p[2])
                       : cubic_of_cubic_spline(p[0], p[1], p[2], p[3]);
}

void Curve::make_segments() {
    const std::size_t count = segment_count();
    const float from = width0.value_or(width), to = width1.value_or(width);
    segments_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        CurveSegment& s = segments_[i];
        s.points = points_of(i);
        s.width0 = lerp(static_cast<float>(i) / static_cast<float>(count), from, to);
        s.width1 = lerp(static_cast<float>(i + 1) / static_cast<float>(count), from, to);
        if (type != CurveType::ribbon) continue;
        s.normal0 = normalize(N[i]);
        s.normal1 = normalize(N[i + 1]);
    }
    depth_ = useful_depth();
}

// The boxes of parts that are hardly longer than wide are no tighter than those of longer ones, and many
// more.
int Curve::useful_depth() const {
    constexpr float shortest = 3; // widths
    float longest = 0;
    for (const CurveSegment& s : segments_) {
        float length_of_segment = 0;
        for (std::size_t i = 1; i < s.points.size(); ++i)
            length_of_segment += length(s.points[i] - s.points[i - 1]);
        longest = std::max(longest, length_of_segment / std::max(s.width0, s.width1));
    }
    int depth = 0;
    while (depth < splitdepth && longest > shortest * static_cast<float>(2 << depth)) ++depth;
    return depth;
}

// Where the transformation only turns, moves and resizes, the segments are put into the world, so that rays
// need not be taken into object space.
void Curve::place(const Transform& t, bool is_similarity, bool reverse) {
    is_turned_ = reverse != t.swaps_handedness();
    const float scale = static_cast<float>(std::cbrt(std::abs(t.matrix().determinant3())));
    is_in_world_ = is_similarity && !t.swaps_handedness();
    for (int i = 0; i < 3; ++i) {
        const auto& row = t.matrix().m[static_cast<std::size_t>(i)];
        const Vec3 r(static_cast<float>(row[0]), static_cast<float>(row[1]), static_cast<float>(row[2]));
        ball_extent_[i] = length(r) / (is_in_world_ ? scale : 1);
        cube_extent_[i] = (std::abs(r.x) + std::abs(r.y) + std::abs(r.z)) / (is_in_world_ ? scale : 1);
    }
    if (!is_in_world_) {
        world_from_object_ = t;
        return;
    }
    for (CurveSegment& s : segments_) {
        for (Vec3& p : s.points) p = Vec3(t.point(Vec3d(p)));
        s.width0 *= scale;
        s.width1 *= scale;
        s.normal0 = t.vector(s.normal0) / scale;
        s.normal1 = t.vector(s.normal1) / scale;
    }
}

Bounds3 Curve::bounds(std::uint32_t primitive) const {
    const Part part = part_of(primitive);
    CubicBezier points = bezier_part(part.segment.points, part.u0, part.u1);
    if (!is_in_world_)
        for (Vec3& p : points) p = world_from_object_.point(p);
    const float radius = 0.5f * std::max(part.segment.width(part.u0), part.segment.width(part.u1));
    Bounds3 box;
    for (int i = 0; i < 3; ++i) {
        const auto [lo, hi] = bezier_range(points, i);
        // What the points' own rounding may amount to.
        const float slack = 1e-6f * (std::max(std::abs(lo), std::abs(hi)) + radius * ball_extent_[i]);
        box.lo[i] = lo - radius * ball_extent_[i] - slack;
        box.hi[i] = hi + radius * ball_extent_[i] + slack;
    }
    return box;
}

Hit Curve::surface(const Ray& ray, std::uint32_t primitive, const Intersection& met) const {
    const CurveSegment& segment = part_of(primitive).segment;
    const Ray local = into_object(ray);
    const auto [dpdu, dpdv] = segment.tangents(local, type, met.u, met.v);
    Hit hit;
    hit.p = ray.at(met.t);
    // The hit is not on a surface, but somewhere in the strand: rays start beside all of it (as in pbrt-v4).
    hit.p_error = cube_extent_ * segment.seen_width(type, met.u, normalize(local.d));
    hit.wo = normalize(-ray.d);
    hit.dpdu = world_from_object_.vector(dpdu);
    hit.dpdv = world_from_object_.vector(dpdv);
    const Vec3 n = normalize(world_from_object_.normal(normalize(cross(dpdu, dpdv))));
    hit.ng = hit.ns = is_turned_ ? -n : n;
    hit.uv = {met.u, met.v};
    hit.t = met.t;
    hit.time = ray.time;
    hit.primitive = primitive;
    return hit;
}

// Length times mean width, by Simpson's rule.
float Curve::area(std::uint32_t primitive) const {
    const Part part = part_of(primitive);
    constexpr int n = 16;
    const float step = (part.u1 - part.u0) / n;
    float sum = 0;
    for (int i = 0; i <= n; ++i) {
        const float u = part.u0 + static_cast<float>(i) * step;
        const float weight = i == 0 || i == n ? 1 : i % 2 ? 4 : 2;
        sum += weight * part.segment.width(u) *
               length(world_from_object_.vector(bezier_derivative(part.segment.points, u)));
    }
    return sum * step / 3;
}

} // namespace

Kind<Shape> curve_shape() {
    return make_kind<Shape, Curve>("curve");
}

} // namespace alhazen
