/// The watertight ray-triangle test: Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection".
///
/// The vertices are moved so that the ray starts at the origin, the axis the ray mostly follows is made z,
/// and a shear turns the ray into the z axis. Then the ray hits if the origin of the xy plane lies in the
/// projected triangle: a question of the signs of three edge functions. Two triangles that share an edge
/// compute the same number for it with opposite signs, so no ray slips through between them.
#pragma once

#include "accel/intersection.h"
#include "base/lanes.h"
#include "base/ray.h"

namespace alhazen {

/// What the test needs to know of a ray; made once a ray, used for every triangle.
struct RayShear {
    int z;            ///< the axis along which the direction is longest
    float sx, sy, sz; ///< shear of the two axes after z, scale of z

    explicit RayShear(const Ray& ray) : z(longest_axis(ray.d)) {
        const float d[5] = {ray.d.x, ray.d.y, ray.d.z, ray.d.x, ray.d.y};
        const Lanes4 shear = Lanes4{d[z + 1], d[z + 2], 1, 1} / all_lanes(d[z]);
        sx = shear[0];
        sy = shear[1];
        sz = shear[2];
    }
    /// max_dimension without branches, which half of the rays would mispredict.
    static int longest_axis(Vec3 d) {
        const float x = std::abs(d.x), y = std::abs(d.y), z_length = std::abs(d.z);
        const int y_or_x = 1 - static_cast<int>(x > y);
        const int is_z = 1 - static_cast<int>(std::max(x, y) > z_length);
        return is_z * 2 + (1 - is_z) * y_or_x;
    }
    /// Of a ray whose shear is known.
    RayShear(int z_, float sx_, float sy_, float sz_) : z(z_), sx(sx_), sy(sy_), sz(sz_) {}
};

namespace triangle_detail {

// The ray's parameter at the triangle's plane, without rounding that matters; NaN for a triangle without
// area.
inline float exact_distance(const Ray& ray, Vec3 a, Vec3 b, Vec3 c) {
    Vec3d da(a), n = cross(Vec3d(b) - da, Vec3d(c) - da);
    return static_cast<float>(dot(n, da - Vec3d(ray.o)) / dot(n, Vec3d(ray.d)));
}

// Whether the corners lie on one line; rounding can make such a triangle look as if it had area.
inline bool is_degenerate(Vec3 a, Vec3 b, Vec3 c) {
    Vec3d da(a);
    return cross(Vec3d(b) - da, Vec3d(c) - da) == Vec3d{};
}

// Bound of the absolute error of t (Pharr, Jakob and Humphreys 2023, section 6.8.7): z are the vertices'
// distances, x and y their sheared coordinates, e the edge functions.
inline float t_error(Vec3 x, Vec3 y, Vec3 z, Vec3 e, float inverse_determinant) {
    float max_x = max_component(abs(x)), max_y = max_component(abs(y)), max_z = max_component(abs(z));
    float max_e = max_component(abs(e));
    float delta_x = gamma_bound(5) * (max_x + max_z), delta_y = gamma_bound(5) * (max_y + max_z);
    float delta_e = 2 * (gamma_bound(2) * max_x * max_y + delta_y * max_x + delta_x * max_y);
    float delta_z = gamma_bound(3) * max_z;
    return 3 * (gamma_bound(3) * max_e * max_z + delta_e * max_z + delta_z * max_e) *
           std::abs(inverse_determinant);
}

// A vertex relative to the ray's origin, in the ray's axes.
struct Sheared {
    float x, y, z;
};
template <int Z>
Sheared shear_vertex(Vec3 p, Vec3 o, const RayShear& s) {
    constexpr int X = (Z + 1) % 3, Y = (Z + 2) % 3;
    Vec3 q = p - o;
    return {q[X] - s.sx * q[Z], q[Y] - s.sy * q[Z], q[Z]};
}

// Edge function of the edge from p to q, with a sign that can be trusted when it is not far from zero.
inline float edge_float(const Sheared& p, const Sheared& q) {
    return p.x * q.y - p.y * q.x;
}
inline double edge_double(const Sheared& p, const Sheared& q) {
    return static_cast<double>(p.x) * q.y - static_cast<double>(p.y) * q.x;
}

template <int Z>
bool intersect(const Ray& ray, const RayShear& s, Vec3 va, Vec3 vb, Vec3 vc, Intersection& hit) {
    const Sheared a = shear_vertex<Z>(va, ray.o, s), b = shear_vertex<Z>(vb, ray.o, s),
                  c = shear_vertex<Z>(vc, ray.o, s);
    float ea = edge_float(b, c), eb = edge_float(c, a), ec = edge_float(a, b);
    if (ea == 0 || eb == 0 || ec == 0) {
        ea = static_cast<float>(edge_double(b, c));
        eb = static_cast<float>(edge_double(c, a));
        ec = static_cast<float>(edge_double(a, b));
    }
    if ((ea < 0 || eb < 0 || ec < 0) && (ea > 0 || eb > 0 || ec > 0)) return false;
    float determinant = ea + eb + ec;
    // Also false for NaN.
    if (!(determinant != 0)) return false;
    float inverse = 1 / determinant;
    Vec3 z{a.z * s.sz, b.z * s.sz, c.z * s.sz};
    float t = (ea * z.x + eb * z.y + ec * z.z) * inverse;

    // Near the origin only the exact side of the plane tells whether the ray has left the surface. Which way
    // t is computed must not depend on tmax, or equal triangles would differ.
    float error = t_error({a.x, b.x, c.x}, {a.y, b.y, c.y}, z, {ea, eb, ec}, inverse);
    if (std::abs(t) <= error) t = exact_distance(ray, va, vb, vc);
    if (!(t > 0) || !(t < ray.tmax) || is_degenerate(va, vb, vc)) return false;
    float u = eb * inverse, v = ec * inverse;
    if (!std::isfinite(u) || !std::isfinite(v)) return false;
    hit.t = t;
    hit.u = u;
    hit.v = v;
    return true;
}

} // namespace triangle_detail

/// Whether the ray meets the triangle a b c at 0 < t < ray.tmax; then sets hit's t, u and v (the weights of b
/// and c) and leaves the rest alone. Both sides are hit; a triangle without area never is.
inline bool intersect_triangle(const Ray& ray, const RayShear& shear, Vec3 a, Vec3 b, Vec3 c,
                               Intersection& hit) {
    switch (shear.z) {
    case 0:
        return triangle_detail::intersect<0>(ray, shear, a, b, c, hit);
    case 1:
        return triangle_detail::intersect<1>(ray, shear, a, b, c, hit);
    default:
        return triangle_detail::intersect<2>(ray, shear, a, b, c, hit);
    }
}

} // namespace alhazen
