#include "shapes/triangle_mesh.h"

#include "math/warp.h"
#include "shapes/mesh_arrays.h"
#include "shapes/rounding.h"
#include "shapes/spherical_triangle.h"

namespace alhazen {

namespace {

template <class V>
V weigh(const std::vector<V>& values, const int* corners, Vec3d b) {
    auto at = [&](int i) { return values[static_cast<std::size_t>(corners[i])]; };
    return at(0) * static_cast<float>(b.x) + at(1) * static_cast<float>(b.y) +
           at(2) * static_cast<float>(b.z);
}

Vec3d weigh_exactly(const std::vector<Vec3>& values, const int* corners, Vec3d b) {
    auto at = [&](int i) { return Vec3d(values[static_cast<std::size_t>(corners[i])]); };
    return at(0) * b.x + at(1) * b.y + at(2) * b.z;
}

Vec3d weights_of(const Intersection& met) {
    double u = static_cast<double>(met.u), v = static_cast<double>(met.v);
    return {1 - u - v, u, v};
}

} // namespace

void TriangleMesh::prepare(const Place& place, const std::string& prefix, BuildContext& context) {
    MeshChecks checks{context.messages, place, prefix};
    std::size_t errors = context.messages.error_count();
    if (indices.empty() && P.size() == 3) indices = {0, 1, 2};
    checks.counts(P.size(), {{"N", N.size()}, {"S", S.size()}, {"uv", uv.size()}});
    checks.indices(indices, 3, "triangle", P.size());
    checks.finite("P", P);
    checks.finite("N", N);
    checks.finite("uv", uv);
    if (context.messages.error_count() != errors) return;
    is_turned_ = context.reverse_orientation != context.world_from_node.swaps_handedness();
    positions_to_world(P, context.world_from_node);
    normals_to_world(N, context.world_from_node, context.reverse_orientation);
    for (Vec3& s : S) s = context.world_from_node.vector(s);
    checks.finite_in_world(P);
}

std::array<Vec2, 3> TriangleMesh::corner_uv(std::uint32_t triangle) const {
    if (uv.empty()) return {Vec2{0, 0}, Vec2{1, 0}, Vec2{1, 1}};
    const int* i = corner_indices(triangle);
    return {uv[static_cast<std::size_t>(i[0])], uv[static_cast<std::size_t>(i[1])],
            uv[static_cast<std::size_t>(i[2])]};
}

Vec3d TriangleMesh::oriented(Vec3d n) const {
    double size = length(n);
    if (!(size > 0)) return {0, 0, 1};
    return n * ((is_turned_ ? -1 : 1) / size);
}

Vec3d TriangleMesh::face_normal(std::uint32_t triangle) const {
    auto [a, b, c] = vertices(triangle);
    return oriented(cross(Vec3d(b) - Vec3d(a), Vec3d(c) - Vec3d(a)));
}

Vec3d TriangleMesh::vertex_normal(std::uint32_t triangle, Vec3d b) const {
    return N.empty() ? Vec3d{} : weigh_exactly(N, corner_indices(triangle), b);
}

Bounds3 TriangleMesh::bounds(std::uint32_t triangle) const {
    Bounds3 box;
    for (Vec3 p : vertices(triangle)) box.extend(p);
    return box;
}

/// A triangle by one corner and the two sides from there.
struct TriangleMesh::Sides {
    Vec3d a, ab, ac;
    Vec3d magnitude; ///< sum of the corners' absolute coordinates

    explicit Sides(const std::array<Vec3, 3>& corners)
        : a(corners[0]), ab(Vec3d(corners[1]) - a), ac(Vec3d(corners[2]) - a),
          magnitude(abs_sum(a, Vec3d(corners[1]), Vec3d(corners[2]))) {}
};

Hit TriangleMesh::plain_surface(const Ray& ray, std::uint32_t triangle, const Intersection& met) const {
    return plain_hit(ray, triangle, met, Sides(vertices(triangle)));
}

Hit TriangleMesh::surface(const Ray& ray, std::uint32_t triangle, const Intersection& met) const {
    const Sides sides(vertices(triangle));
    Hit hit = plain_hit(ray, triangle, met, sides);
    const Vec3d b = weights_of(met);
    const auto corner = corner_uv(triangle);
    hit.uv = corner[0] * static_cast<float>(b.x) + corner[1] * static_cast<float>(b.y) +
             corner[2] * static_cast<float>(b.z);
    set_tangents(hit, sides.ab, sides.ac, Vec2d(corner[1]) - Vec2d(corner[0]),
                 Vec2d(corner[2]) - Vec2d(corner[0]));
    if (!N.empty() || !S.empty())
        set_shading_tangents(hit, S.empty() ? Vec3() : weigh(S, corner_indices(triangle), b));
    return hit;
}

Hit TriangleMesh::plain_hit(const Ray& ray, std::uint32_t triangle, const Intersection& met,
                            const Sides& sides) const {
    const Vec3d b = weights_of(met), p = sides.a + sides.ab * b.y + sides.ac * b.z;
    Hit hit;
    hit.p = Vec3(p);
    hit.p_error = rounding_error(p, sides.magnitude);
    hit.wo = Vec3(normalize(Vec3d(-ray.d)));
    hit.ng = hit.ns = Vec3(oriented(cross(sides.ab, sides.ac)));
    if (!N.empty()) {
        Vec3d ns = vertex_normal(triangle, b);
        double size = length(ns);
        // Vertex normals decide which side is outside.
        if (dot(Vec3d(hit.ng), ns) < 0) hit.ng = -hit.ng;
        hit.ns = size > 0 && std::isfinite(size) ? Vec3(ns * (1 / size)) : hit.ng;
    }
    hit.t = met.t;
    hit.time = ray.time;
    hit.primitive = triangle;
    return hit;
}

// p is linear in uv, so two edges give the derivatives, unless the parameters do not span the plane.
void TriangleMesh::set_tangents(Hit& hit, Vec3d ab, Vec3d ac, Vec2d uv_ab, Vec2d uv_ac) {
    const double determinant = uv_ab.x * uv_ac.y - uv_ab.y * uv_ac.x;
    if (determinant * determinant > 1e-18 * length_squared(uv_ab) * length_squared(uv_ac)) {
        const double scale = 1 / determinant;
        hit.dpdu = Vec3((ab * uv_ac.y - ac * uv_ab.y) * scale);
        hit.dpdv = Vec3((ac * uv_ab.x - ab * uv_ac.x) * scale);
    } else {
        Frame frame = Frame::from_z(hit.ng);
        hit.dpdu = frame.x;
        hit.dpdv = frame.y;
    }
}

// Tangents laid across the shading normal. The parameters' own keep what they say of lengths and angles,
// which bumps and footprints of textures go by; one that the mesh gives instead of them is completed to a
// square.
void TriangleMesh::set_shading_tangents(Hit& hit, Vec3 tangent) {
    auto across = [&](Vec3 t) { return t - hit.ns * dot(hit.ns, t); };
    const bool is_given = length_squared(tangent) > 0;
    const Vec3 u = across(is_given ? tangent : hit.dpdu),
               v = is_given ? cross(hit.ns, tangent) : across(hit.dpdv);
    if (length_squared(cross(u, v)) > 0) {
        hit.dpdu = u;
        hit.dpdv = v;
    } else {
        Frame frame = Frame::from_z(hit.ns);
        hit.dpdu = frame.x;
        hit.dpdv = frame.y;
    }
}

// The interpolated normal is linear in uv; of its derivatives, what turns the unit normal counts.
NormalChange TriangleMesh::normal_change(const Hit& hit) const {
    if (N.empty()) return {};
    const int* i = corner_indices(hit.primitive);
    auto normal = [&](int c) { return Vec3d(N[static_cast<std::size_t>(i[c])]); };
    const auto corner = corner_uv(hit.primitive);
    const Vec2d uv_ab = Vec2d(corner[1]) - Vec2d(corner[0]), uv_ac = Vec2d(corner[2]) - Vec2d(corner[0]);
    const Vec2d from_a = Vec2d(hit.uv) - Vec2d(corner[0]);
    const double determinant = uv_ab.x * uv_ac.y - uv_ab.y * uv_ac.x;
    if (!(determinant * determinant > 1e-18 * length_squared(uv_ab) * length_squared(uv_ac))) return {};
    const Vec3d ab = normal(1) - normal(0), ac = normal(2) - normal(0);
    const Vec3d dndu = (ab * uv_ac.y - ac * uv_ab.y) * (1 / determinant);
    const Vec3d dndv = (ac * uv_ab.x - ab * uv_ac.x) * (1 / determinant);
    const double size = length(normal(0) + dndu * from_a.x + dndv * from_a.y);
    if (!(size > 0)) return {};
    auto turning = [&](Vec3d d) { return Vec3((d - Vec3d(hit.ns) * dot(Vec3d(hit.ns), d)) * (1 / size)); };
    return {turning(dndu), turning(dndv)};
}

float TriangleMesh::area(std::uint32_t triangle) const {
    auto [a, b, c] = vertices(triangle);
    return static_cast<float>(0.5 * length(cross(Vec3d(b) - Vec3d(a), Vec3d(c) - Vec3d(a))));
}

ShapeSample TriangleMesh::sample_at(std::uint32_t triangle, Vec2 weights, float pdf) const {
    // Their sum must be 1 to the precision of p_error.
    const Vec3d b(1 - static_cast<double>(weights.x) - static_cast<double>(weights.y),
                  static_cast<double>(weights.x), static_cast<double>(weights.y));
    auto [pa, pb, pc] = vertices(triangle);
    const Vec3d a(pa), ab = Vec3d(pb) - a, ac = Vec3d(pc) - a;
    const Vec3d p = a + ab * b.y + ac * b.z;
    Vec3d ng = oriented(cross(ab, ac));
    if (!N.empty() && dot(ng, vertex_normal(triangle, b)) < 0) ng = -ng;
    auto corner = corner_uv(triangle);
    Vec2 at = corner[0] * static_cast<float>(b.x) + corner[1] * weights.x + corner[2] * weights.y;
    return {Vec3(p), rounding_error(p, abs_sum(a, Vec3d(pb), Vec3d(pc))), Vec3(ng), at, pdf};
}

ShapeSample TriangleMesh::sample(std::uint32_t triangle, Vec2 u) const {
    Vec3 b = sample_triangle(u);
    return sample_at(triangle, {b.y, b.z}, 1 / area(triangle));
}

std::optional<ShapeSample> TriangleMesh::sample_from(std::uint32_t triangle, Vec3 reference, Vec2 u) const {
    auto [a, b, c] = vertices(triangle);
    SphericalTriangle seen{a, b, c, reference};
    float solid_angle = sampled_solid_angle(seen);
    if (solid_angle == 0) return Shape::sample_from(triangle, reference, u);
    return sample_at(triangle, seen.sample(u), 1 / solid_angle);
}

float TriangleMesh::pdf_from(std::uint32_t triangle, Vec3 reference, const Hit& hit, Vec3 wi) const {
    auto [a, b, c] = vertices(triangle);
    float solid_angle = sampled_solid_angle({a, b, c, reference});
    return solid_angle == 0 ? Shape::pdf_from(triangle, reference, hit, wi) : 1 / solid_angle;
}

Shape::NormalCone TriangleMesh::normals(std::uint32_t triangle) const {
    Vec3d n = face_normal(triangle);
    if (N.empty()) return {Vec3(n), 1};
    // Turned to the side of the vertex normals; where these disagree, so do the triangle's two sides.
    double side = 0;
    for (int i = 0; i < 3; ++i) {
        Vec3d b;
        b[i] = 1;
        double s = dot(n, vertex_normal(triangle, b));
        if (side * s < 0) return {};
        if (s != 0) side = s;
    }
    return {Vec3(side < 0 ? -n : n), 1};
}

} // namespace alhazen
