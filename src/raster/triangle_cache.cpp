#include "raster/triangle_cache.h"

namespace alhazen {

void TriangleCache::set(const PlacedSurface& surface, std::uint32_t triangle) {
    if (surface_ != &surface) {
        surface_ = &surface;
        mesh_ = surface.placed().shape->triangles();
        has_normals_ = !mesh_->N.empty();
        outwards_ = mesh_->is_turned() ? -1.0f : 1.0f;
    }
    triangle_ = triangle;
    corner_ = mesh_->corner_indices(triangle);
    has_common_ = false;
    a_ = at_corner(mesh_->P, 0);
    ab_ = at_corner(mesh_->P, 1) - a_;
    ac_ = at_corner(mesh_->P, 2) - a_;
    n_ = cross(ab_, ac_);
    const float size2 = length_squared(n_);
    ng_ = size2 > 0 ? n_ * (outwards_ / std::sqrt(size2)) : Vec3{0, 0, 1};
    if (!has_normals_) return;
    find_weights();
    ns_ = at_corner(mesh_->N, 0);
    ns_along_u_ = at_corner(mesh_->N, 1) - ns_;
    ns_along_v_ = at_corner(mesh_->N, 2) - ns_;
}

void TriangleCache::find_weights() {
    const float size2 = length_squared(n_);
    const float scale = size2 > 0 ? 1 / size2 : 0;
    to_u_ = cross(ac_, n_) * scale;
    to_v_ = cross(n_, ab_) * scale;
}

void TriangleCache::find_common() {
    if (!has_normals_) find_weights();
    const PlacedShape& placed = surface_->placed();
    common_ = {};
    common_.shape = surface_->shape;
    common_.primitive = triangle_;
    common_.material = placed.material;
    common_.area_light = placed.lights.empty() ? nullptr : placed.lights[triangle_];
    uv_ = {0, 0};
    uv_along_u_ = {1, 0};
    uv_along_v_ = {1, 1};
    if (!mesh_->uv.empty()) {
        uv_ = at_corner(mesh_->uv, 0);
        uv_along_u_ = at_corner(mesh_->uv, 1) - uv_;
        uv_along_v_ = at_corner(mesh_->uv, 2) - uv_;
    }
    const float determinant = uv_along_u_.x * uv_along_v_.y - uv_along_u_.y * uv_along_v_.x;
    if (determinant != 0) {
        common_.dpdu = (ab_ * uv_along_v_.y - ac_ * uv_along_u_.y) / determinant;
        common_.dpdv = (ac_ * uv_along_u_.x - ab_ * uv_along_v_.x) / determinant;
    } else {
        const Frame frame = Frame::from_z(ng_);
        common_.dpdu = frame.x;
        common_.dpdv = frame.y;
    }
    if (!mesh_->S.empty() && length_squared(at_corner(mesh_->S, 0)) > 0)
        common_.dpdu = at_corner(mesh_->S, 0);
    has_common_ = true;
}

TriangleCache::Normals TriangleCache::normals(Vec2 weights) const {
    if (!has_normals_) return {ng_, ng_};
    const Vec3 ns = ns_ + ns_along_u_ * weights.x + ns_along_v_ * weights.y;
    const float size2 = length_squared(ns);
    if (!(size2 > 0)) return {ng_, ng_};
    const Vec3 unit = ns / std::sqrt(size2);
    return {dot(ng_, unit) < 0 ? -ng_ : ng_, unit};
}

void TriangleCache::fill(Vec3 o, Vec3 d, Hit& hit) {
    if (!has_common_) find_common();
    const Vec3 from = o - a_;
    const float slope = dot(n_, d);
    const float t = slope != 0 ? -dot(n_, from) / slope : 0.0f;
    const Vec3 place = from + d * t;
    const Vec2 w = weights(place);
    const Normals n = normals(w);
    hit = common_;
    hit.p = a_ + place;
    hit.wo = d / -length(d);
    hit.uv = uv_ + uv_along_u_ * w.x + uv_along_v_ * w.y;
    hit.ng = n.ng;
    hit.ns = n.ns;
}

} // namespace alhazen
