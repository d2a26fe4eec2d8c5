#include "shapes/bilinear_mesh.h"

#include <bit>

#include "accel/primitives.h"
#include "base/hash.h"
#include "math/density.h"
#include "shapes/mesh_arrays.h"
#include "shapes/rounding.h"

namespace alhazen {

void BilinearMesh::prepare(const Place& place, const std::string& prefix, BuildContext& context) {
    MeshChecks checks{context.messages, place, prefix};
    std::size_t errors = context.messages.error_count();
    if (indices.empty() && P.size() == 4) indices = {0, 1, 2, 3};
    checks.counts(P.size(), {{"N", N.size()}, {"uv", uv.size()}});
    checks.indices(indices, 4, "patch", P.size());
    checks.finite("P", P);
    checks.finite("N", N);
    checks.finite("uv", uv);
    if (context.messages.error_count() != errors) return;
    is_turned_ = context.reverse_orientation != context.world_from_node.swaps_handedness();
    positions_to_world(P, context.world_from_node);
    normals_to_world(N, context.world_from_node, context.reverse_orientation);
    checks.finite_in_world(P);
}

Bounds3 BilinearMesh::bounds(std::uint32_t patch) const {
    Bounds3 box;
    for (int i = 0; i < 4; ++i) box.extend(P[corner(patch, i)]);
    return box;
}

bool BilinearMesh::intersect(const Ray& ray, std::uint32_t patch, Intersection& hit) const {
    BilinearPatch::Hit met;
    if (!geometry(patch).intersect(Vec3d(ray.o), Vec3d(ray.d), static_cast<double>(ray.tmax), met))
        return false;
    auto t = static_cast<float>(met.t);
    if (!(t > 0) || !(t < ray.tmax)) return false;
    hit.t = t;
    hit.u = static_cast<float>(met.u);
    hit.v = static_cast<float>(met.v);
    return true;
}

Vec3 BilinearMesh::outward(std::uint32_t patch, const BilinearPatch& g, Vec2 at) const {
    Vec3 n(g.normal(static_cast<double>(at.x), static_cast<double>(at.y)));
    if (is_turned_) n = -n;
    // Vertex normals decide which side is outside.
    return N.empty() ? n : face_forward(n, interpolate(N, patch, at));
}

Vec3 BilinearMesh::point_error(std::uint32_t patch, Vec3d p) const {
    BilinearPatch g = geometry(patch);
    return rounding_error(p, abs_sum(g.p00, g.p10, g.p01) + abs(g.p11));
}

Hit BilinearMesh::surface(const Ray& ray, std::uint32_t patch, const Intersection& met) const {
    BilinearPatch g = geometry(patch);
    Vec2 at{met.u, met.v};
    Vec3d p = g.at(static_cast<double>(met.u), static_cast<double>(met.v));
    Hit hit;
    hit.p = Vec3(p);
    hit.p_error = point_error(patch, p);
    hit.wo = Vec3(normalize(Vec3d(-ray.d)));
    hit.ng = hit.ns = outward(patch, g, at);
    if (!N.empty()) {
        Vec3d ns(interpolate(N, patch, at));
        double size = length(ns);
        if (size > 0 && std::isfinite(size)) hit.ns = Vec3(ns * (1 / size));
    }
    hit.uv = uv.empty() ? at : interpolate(uv, patch, at);
    hit.t = met.t;
    hit.time = ray.time;
    hit.primitive = patch;
    set_tangents(patch, g, at, hit);
    return hit;
}

void BilinearMesh::set_tangents(std::uint32_t patch, const BilinearPatch& g, Vec2 at, Hit& hit) const {
    Vec3d dpdu = g.dpdu(static_cast<double>(at.y)), dpdv = g.dpdv(static_cast<double>(at.x));
    if (!uv.empty()) {
        // By the patch's place (x, y): p's derivatives by uv are those by place, times place's by uv.
        Vec2d c00(uv[corner(patch, 0)]), c10(uv[corner(patch, 1)]), c01(uv[corner(patch, 2)]),
            c11(uv[corner(patch, 3)]);
        double x = static_cast<double>(at.x), y = static_cast<double>(at.y);
        Vec2d by_x = (c10 - c00) * (1 - y) + (c11 - c01) * y, by_y = (c01 - c00) * (1 - x) + (c11 - c10) * x;
        double determinant = by_x.x * by_y.y - by_x.y * by_y.x;
        if (std::abs(determinant) > 1e-9 * length(by_x) * length(by_y)) {
            Vec3d by_place_x = dpdu, by_place_y = dpdv;
            dpdu = (by_place_x * by_y.y - by_place_y * by_x.y) * (1 / determinant);
            dpdv = (by_place_y * by_x.x - by_place_x * by_y.x) * (1 / determinant);
        }
    }
    if (!N.empty()) {
        // Laid across the shading normal.
        Vec3d ns(hit.ns);
        dpdu = dpdu - ns * dot(ns, dpdu);
        dpdv = dpdv - ns * dot(ns, dpdv);
    }
    hit.dpdu = Vec3(dpdu);
    hit.dpdv = Vec3(dpdv);
}

bool BilinearMesh::tessellate(double tolerance, const TriangleSink& out) const {
    for (std::uint32_t patch = 0; patch < primitive_count(); ++patch) {
        const BilinearPatch g = geometry(patch);
        const int n = g.cuts(tolerance);
        auto at = [&](int i, int j) {
            return Vec3(g.at(static_cast<double>(i) / n, static_cast<double>(j) / n));
        };
        auto add = [&](Vec3 a, Vec3 b, Vec3 c) { out(is_turned_ ? Corners{a, c, b} : Corners{a, b, c}); };
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                add(at(i, j), at(i + 1, j), at(i + 1, j + 1));
                add(at(i, j), at(i + 1, j + 1), at(i, j + 1));
            }
    }
    return true;
}

// The parameters are drawn by the bilinear mean of the area at the corners, which is nowhere below the area
// itself (that is the length of a vector linear in the parameters), and kept in proportion to what is too
// much: for a flat patch always. The further numbers are drawn from u, so that the same u gives the same
// point.
ShapeSample BilinearMesh::sample(std::uint32_t patch, Vec2 u) const {
    constexpr int most_tries = 256;
    BilinearPatch g = geometry(patch);
    auto size = [&](double x, double y) { return length(g.area_vector(x, y)); };
    std::array corner_size{size(0, 0), size(1, 0), size(0, 1), size(1, 1)};
    double largest = *std::max_element(corner_size.begin(), corner_size.end());
    BilinearHeights heights;
    for (std::size_t i = 0; i < 4; ++i) heights[i] = static_cast<float>(corner_size[i] / largest);
    Rng rng(hash_of(std::bit_cast<std::uint32_t>(u.x), std::bit_cast<std::uint32_t>(u.y)));
    Vec2 at;
    for (int i = 0; i < most_tries; ++i) {
        at = sample_bilinear(u, heights);
        double x = static_cast<double>(at.x), y = static_cast<double>(at.y);
        double proposed = lerp(at.y, lerp(at.x, heights[0], heights[1]), lerp(at.x, heights[2], heights[3]));
        // The float weights' rounding must not reject points of a flat patch.
        if (static_cast<double>(rng.uniform()) * proposed * largest <= size(x, y) * (1 + 1e-6)) break;
        u = {rng.uniform(), rng.uniform()};
    }
    Vec3d p = g.at(static_cast<double>(at.x), static_cast<double>(at.y));
    return {Vec3(p), point_error(patch, p), outward(patch, g, at),
            uv.empty() ? at : interpolate(uv, patch, at), 1 / area(patch)};
}

// The normals lie within the cone of the corners' normals, since the area vector is linear in the parameters.
Shape::NormalCone BilinearMesh::normals(std::uint32_t patch) const {
    BilinearPatch g = geometry(patch);
    std::array<Vec3, 4> n;
    Vec3 sum;
    int kept = 0;
    for (int i = 0; i < 4; ++i) {
        Vec2 at{static_cast<float>(i & 1), static_cast<float>(i >> 1)};
        Vec3 corner_normal = outward(patch, g, at);
        kept += dot(Vec3d(corner_normal), g.normal(static_cast<double>(at.x), static_cast<double>(at.y))) > 0;
        n[static_cast<std::size_t>(i)] = corner_normal;
        sum += corner_normal;
    }
    // Vertex normals may turn one corner and not another; then anything can be in between.
    if (kept != 0 && kept != 4) return {};
    if (!(length_squared(sum) > 0)) return {};
    NormalCone cone{normalize(sum), 1};
    for (Vec3 corner_normal : n) cone.cosine = std::min(cone.cosine, dot(cone.axis, corner_normal) - 1e-6f);
    // A cone wider than a half space bounds nothing in between.
    return cone.cosine > 0 ? cone : NormalCone{};
}

} // namespace alhazen
