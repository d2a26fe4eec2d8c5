#include "shapes/placement.h"

#include "shapes/rounding.h"

namespace alhazen {

namespace {

constexpr double pi_double = 3.14159265358979323846;

Vec3d row(const Matrix4& a, std::size_t i) {
    return {a.m[i][0], a.m[i][1], a.m[i][2]};
}

// Whether the matrix is a similarity: its columns are orthogonal and of one length.
bool keeps_shapes(const Matrix4& m, double relative_tolerance) {
    Matrix4 t = m.transposed();
    Vec3d x = row(t, 0), y = row(t, 1), z = row(t, 2);
    double xx = dot(x, x), tolerance = relative_tolerance * xx;
    return std::abs(dot(y, y) - xx) < tolerance && std::abs(dot(z, z) - xx) < tolerance &&
           std::abs(dot(x, y)) < tolerance && std::abs(dot(y, z)) < tolerance &&
           std::abs(dot(z, x)) < tolerance;
}

// c +- half, rounded outward.
Bounds3 box_around(Vec3d c, Vec3d half) {
    Bounds3 b;
    for (int i = 0; i < 3; ++i) {
        double slack = 1e-15 * (std::abs(c[i]) + half[i]);
        b.lo[i] = next_down(static_cast<float>(c[i] - half[i] - slack));
        b.hi[i] = next_up(static_cast<float>(c[i] + half[i] + slack));
    }
    return b;
}

} // namespace

void Placement::set(const Node& node, const BuildContext& context) {
    world_from_object_ = context.world_from_node;
    const Matrix4& m = world_from_object_.matrix();
    determinant_ = m.determinant3();
    is_turned_ = context.reverse_orientation != (determinant_ < 0);
    if (!std::isfinite(determinant_) || determinant_ == 0)
        context.messages.add_error(node.place,
                                   "the shape's transformation flattens it; it must be invertible");
    is_similarity_ = keeps_shapes(m, 1e-6);
    uniform_scale_.reset();
    if (keeps_shapes(m, 1e-13)) uniform_scale_ = std::cbrt(std::abs(determinant_));
}

Vec3 Placement::point_error(Vec3d p) const {
    Vec3d magnitude;
    for (int i = 0; i < 3; ++i) {
        auto r = static_cast<std::size_t>(i);
        const Matrix4& m = world_from_object_.matrix();
        magnitude[i] = dot(abs(row(m, r)), abs(p)) + std::abs(m.m[r][3]);
    }
    return rounding_error(point(p), magnitude);
}

Vec3d Placement::transposed_inverse(Vec3d n) const {
    const Matrix4& inverse = world_from_object_.inverse_matrix();
    return row(inverse, 0) * n.x + row(inverse, 1) * n.y + row(inverse, 2) * n.z;
}

Vec3 Placement::normal(Vec3d n) const {
    Vec3 world(normalize(transposed_inverse(n)));
    return turned(world);
}

double Placement::solid_angle_ratio(Vec3 w) const {
    double scale = length(world_from_object_.inverse_vector(Vec3d(w)));
    return 1 / (std::abs(determinant_) * scale * scale * scale);
}

Bounds3 Placement::ball_bounds(double radius) const {
    const Matrix4& m = world_from_object_.matrix();
    return box_around(point(Vec3d{}),
                      Vec3d{length(row(m, 0)), length(row(m, 1)), length(row(m, 2))} * radius);
}

Bounds3 Placement::disk_bounds(double radius, double z) const {
    const auto& m = world_from_object_.matrix().m;
    return box_around(point(Vec3d{0, 0, z}), Vec3d{std::hypot(m[0][0], m[0][1]), std::hypot(m[1][0], m[1][1]),
                                                   std::hypot(m[2][0], m[2][1])} *
                                                 radius);
}

Bounds3 Placement::box_bounds(Vec3d lo, Vec3d hi) const {
    const Matrix4& m = world_from_object_.matrix();
    Vec3d half = (hi - lo) * 0.5;
    return box_around(point((lo + hi) * 0.5),
                      {dot(abs(row(m, 0)), half), dot(abs(row(m, 1)), half), dot(abs(row(m, 2)), half)});
}

void sector_box(double radius, double phimax, Vec3d& lo, Vec3d& hi) {
    double c = radius * std::cos(phimax), s = radius * std::sin(phimax);
    lo = {phimax >= pi_double ? -radius : std::min(0.0, c),
          phimax >= 1.5 * pi_double ? -radius : std::min(0.0, s), 0};
    hi = {radius, phimax >= 0.5 * pi_double ? radius : s, 0};
}

} // namespace alhazen
