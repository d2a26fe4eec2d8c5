/// How far points are from the surfaces of the shapes' examples, in double precision, from their equations.
#pragma once

#include <map>

#include "shapes/bilinear_patch.h"
#include "shapes/mesh_arrays.h"
#include "shapes/triangle_mesh.h"
#include "tests/conformance/shape_cases.h"

namespace alhazen::shape_cases {

inline double float_parameter(const Node& node, std::string_view name, double otherwise) {
    const Parameter* p = node.find(name);
    return p ? static_cast<double>(std::get<std::vector<float>>(p->values)[0]) : otherwise;
}

// Newton's method for at(u, v) = p + s n; returns |s|.
inline double distance_to_patch(const BilinearPatch& patch, Vec3d p, Vec3d n) {
    double u = 0.5, v = 0.5, s = 0;
    for (int i = 0; i < 30; ++i) {
        Vec3d f = patch.at(u, v) - p - n * s, x = patch.dpdu(v), y = patch.dpdv(u);
        double determinant = dot(cross(x, y), -n);
        u -= dot(cross(f, y), -n) / determinant;
        v -= dot(cross(x, f), -n) / determinant;
        s -= dot(cross(x, y), f) / determinant;
    }
    return std::abs(s);
}

// The gradient in the world of a function that has the gradient n in object space: by the inverse transpose.
inline Vec3d world_gradient(const ShapeCase& c, Vec3d n) {
    Vec3d g;
    const auto& inverse = c.world_from_object.inverse_matrix().m;
    for (int i = 0; i < 3; ++i) {
        auto k = static_cast<std::size_t>(i);
        g[i] = inverse[0][k] * n.x + inverse[1][k] * n.y + inverse[2][k] * n.z;
    }
    return g;
}

// Surfaces whose parameters are the coordinates across the axis that the normal is nearest to.
inline bool is_projected(const ShapeCase& c) {
    return c.kind == "sdf" || c.kind == "sdfgrid";
}

// How far q, a point of object space next to the surface, is from it in the world.
inline double distance_to_field(const ShapeCase& c, Vec3d q) {
    Dual f;
    if (const Parameter* field = c.node.find("field"))
        f = testing_support::example_sdfs()
                .find(std::get<std::vector<std::string>>(field->values).front())
                ->value(dual_point(q));
    else
        f = testing_support::interpolated(testing_support::example_grid(), q);
    return std::abs(f.v) / length(world_gradient(c, f.d));
}

// The points of a strand's splines in the world, densely, by the recursions of de Casteljau and de Boor.
inline std::vector<Vec3d> points_of_strand(const ShapeCase& c) {
    auto text = [&](std::string_view name, const char* otherwise) {
        const Parameter* p = c.node.find(name);
        return p ? std::get<std::vector<std::string>>(p->values)[0] : std::string(otherwise);
    };
    const Parameter* given = c.node.find("degree");
    const int degree = given ? std::get<std::vector<int>>(given->values)[0] : 3;
    const bool is_spline = text("basis", "bezier") == "bspline";
    const auto& P = std::get<std::vector<Vec3>>(c.node.find("P")->values);
    std::vector<Vec3d> points;
    for (std::size_t first = 0; first + static_cast<std::size_t>(degree) < P.size();
         first += is_spline ? 1 : static_cast<std::size_t>(degree))
        for (int k = 0; k <= 400; ++k) {
            const double u = k / 400.0;
            std::vector<Vec3d> q;
            for (int i = 0; i <= degree; ++i) q.emplace_back(P[first + static_cast<std::size_t>(i)]);
            for (int r = 1; r <= degree; ++r)
                for (int i = degree; i >= r; --i) {
                    // Of a uniform knot vector with the segment at [0, 1].
                    const double a = is_spline ? (u + degree - i) / (degree - r + 1) : u;
                    const auto j = static_cast<std::size_t>(i);
                    q[j] = q[j - 1] * (1 - a) + q[j] * a;
                }
            points.push_back(c.world_from_object.point(q[static_cast<std::size_t>(degree)]));
        }
    return points;
}

inline double distance_to_strand(const ShapeCase& c, Vec3d p) {
    static std::map<std::string, std::vector<Vec3d>> known;
    auto [found, is_new] = known.try_emplace(c.name);
    if (is_new) found->second = points_of_strand(c);
    double least = static_cast<double>(infinity);
    for (const Vec3d& q : found->second) least = std::min(least, length_squared(q - p));
    return std::sqrt(least);
}

// Of a file's triangles and then patches, or of a mesh of patches.
inline double distance_to_face(const ShapeCase& c, const Hit& hit) {
    MeshData mesh = shape_cases::house();
    if (const Parameter* given = c.node.find("P"))
        mesh.P = std::get<std::vector<Vec3>>(given->values), mesh.indices = {},
        mesh.quad_indices = {0, 1, 2, 3};
    if (const Parameter* given = c.node.find("indices"))
        mesh.quad_indices = std::get<std::vector<int>>(given->values);
    const std::size_t n = mesh.triangle_count(), i = hit.primitive;
    const int* corners = i < n ? &mesh.indices[3 * i] : &mesh.quad_indices[4 * (i - n)];
    positions_to_world(mesh.P, c.world_from_object);
    auto at = [&](int k) { return Vec3d(mesh.P[static_cast<std::size_t>(corners[k])]); };
    if (i < n) return std::abs(dot(normalize(cross(at(1) - at(0), at(2) - at(0))), Vec3d(hit.p) - at(0)));
    return distance_to_patch({at(0), at(1), at(2), at(3)}, Vec3d(hit.p), Vec3d(hit.ng));
}

// How far p is from the true surface along its normal, in double precision, from the equations.
inline double distance_to_surface(const ShapeCase& c, const Hit& hit) {
    Vec3d p(hit.p);
    if (const TriangleMesh* mesh = c.shape->triangles()) {
        auto [a, b, d] = mesh->vertices(hit.primitive);
        return std::abs(dot(normalize(cross(Vec3d(b) - Vec3d(a), Vec3d(d) - Vec3d(a))), p - Vec3d(a)));
    }
    // Hits of a strand are within it; what they may be off by is its width.
    if (c.kind == "curve") return distance_to_strand(c, p);
    if (c.kind == "bilinearmesh" || c.kind == "plymesh") return distance_to_face(c, hit);
    Vec3d q = c.world_from_object.inverse_point(p), n{0, 0, 1};
    if (is_projected(c)) return distance_to_field(c, q);
    double radius = float_parameter(c.node, "radius", 1),
           residual = q.z - float_parameter(c.node, "height", 0);
    if (c.kind == "sphere") residual = length(q) - radius, n = normalize(q);
    if (c.kind == "cylinder") residual = std::hypot(q.x, q.y) - radius, n = normalize(Vec3d{q.x, q.y, 0});
    return std::abs(residual) / length(world_gradient(c, n));
}

} // namespace alhazen::shape_cases
