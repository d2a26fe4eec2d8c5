#include "raster/triangle_cache.h"

namespace alhazen {

void TriangleCache::set(const PlacedSurface& surface, std::uint32_t triangle) {
    const PlacedShape& placed = surface.placed();
    const TriangleMesh& mesh = *placed.shape->triangles();
    const int* corner = mesh.corner_indices(triangle);
    auto of = [corner](const auto& values, int i) { return values[static_cast<std::size_t>(corner[i])]; };
    a_ = of(mesh.P, 0);
    const Vec3 ab = of(mesh.P, 1) - a_, ac = of(mesh.P, 2) - a_;
    n_ = cross(ab, ac);
    const float size2 = length_squared(n_);
    const float scale = size2 > 0 ? 1 / size2 : 0;
    to_u_ = cross(ac, n_) * scale;
    to_v_ = cross(n_, ab) * scale;
    common_ = {};
    common_.shape = surface.shape;
    common_.primitive = triangle;
    common_.material = placed.material;
    common_.area_light = placed.lights.empty() ? nullptr : placed.lights[triangle];
    common_.ng = size2 > 0 ? n_ * ((mesh.is_turned() ? -1.0f : 1.0f) * std::sqrt(scale)) : Vec3{0, 0, 1};
    uv_ = {0, 0};
    uv_along_u_ = {1, 0};
    uv_along_v_ = {1, 1};
    if (!mesh.uv.empty()) {
        uv_ = of(mesh.uv, 0);
        uv_along_u_ = of(mesh.uv, 1) - uv_;
        uv_along_v_ = of(mesh.uv, 2) - uv_;
    }
    const float determinant = uv_along_u_.x * uv_along_v_.y - uv_along_u_.y * uv_along_v_.x;
    if (determinant != 0) {
        common_.dpdu = (ab * uv_along_v_.y - ac * uv_along_u_.y) / determinant;
        common_.dpdv = (ac * uv_along_u_.x - ab * uv_along_v_.x) / determinant;
    } else {
        const Frame frame = Frame::from_z(common_.ng);
        common_.dpdu = frame.x;
        common_.dpdv = frame.y;
    }
    if (!mesh.S.empty() && length_squared(of(mesh.S, 0)) > 0) common_.dpdu = of(mesh.S, 0);
    has_normals_ = !mesh.N.empty();
    if (!has_normals_) return;
    ns_ = of(mesh.N, 0);
    ns_along_u_ = of(mesh.N, 1) - ns_;
    ns_along_v_ = of(mesh.N, 2) - ns_;
}

void TriangleCache::fill(Vec3 o, Vec3 d, Hit& hit) const {
    const Vec3 from = o - a_;
    const float slope = dot(n_, d);
    const float t = slope != 0 ? -dot(n_, from) / slope : 0.0f;
    const Vec3 place = from + d * t;
    const float u = std::clamp(dot(place, to_u_), 0.0f, 1.0f), v = std::clamp(dot(place, to_v_), 0.0f, 1 - u);
    hit = common_;
    hit.p = a_ + place;
    hit.wo = d / -length(d);
    hit.uv = uv_ + uv_along_u_ * u + uv_along_v_ * v;
    hit.ns = hit.ng;
    if (!has_normals_) return;
    const Vec3 ns = ns_ + ns_along_u_ * u + ns_along_v_ * v;
    const float size2 = length_squared(ns);
    if (!(size2 > 0)) return;
    hit.ns = ns / std::sqrt(size2);
    // Vertex normals decide which side is outside.
    if (dot(hit.ng, hit.ns) < 0) hit.ng = -hit.ng;
}

} // namespace alhazen
