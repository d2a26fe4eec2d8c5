#include "shapes/bilinear_patch.h"

#include <limits>

namespace alhazen {

Vec3d BilinearPatch::normal(double u, double v) const {
    Vec3d n = area_vector(u, v);
    double size = length(n);
    if (!(size > 0)) {
        n = area_vector(u + 1e-4 * (0.5 - u), v + 1e-4 * (0.5 - v));
        size = length(n);
    }
    return size > 0 ? n * (1 / size) : Vec3d{0, 0, 1};
}

// A piece of 1/n x 1/n is off the two triangles between its corners by at most a quarter of its own twist,
// the patch's over n^2, which is one vector everywhere. Along the surface it does no harm, unless the patch
// is folded.
int BilinearPatch::cuts(double tolerance) const {
    const Vec3d twist = p00 - p10 - p01 + p11, middle = area_vector(0.5, 0.5);
    double height = 0;
    bool is_folded = false;
    for (double u : {0.0, 0.5, 1.0})
        for (double v : {0.0, 0.5, 1.0}) {
            height = std::max(height, std::abs(dot(twist, normal(u, v))));
            is_folded = is_folded || dot(area_vector(u, v), middle) < 0;
        }
    if (is_folded) height = length(twist);
    constexpr double most = 4096;
    return static_cast<int>(std::clamp(std::ceil(std::sqrt(0.25 * height / tolerance)), 1.0, most));
}

// Where the area vectors of the corners all point the same way, their length is linear too, and its mean is
// the mean over the corners. Else Gauss-Legendre with four points in each of four strips, both ways.
double BilinearPatch::area() const {
    const std::array corners{area_vector(0, 0), area_vector(1, 0), area_vector(0, 1), area_vector(1, 1)};
    Vec3d sum_vector;
    double sum_length = 0;
    for (Vec3d c : corners) {
        sum_vector += c;
        sum_length += length(c);
    }
    if (length(sum_vector) >= sum_length * (1 - 1e-12)) return sum_length / 4;
    constexpr std::array x{0.8611363115940526, 0.3399810435848563};
    constexpr std::array w{0.3478548451374538, 0.6521451548625461};
    constexpr int strips = 4;
    std::array<double, 4 * strips> place{}, weight{};
    for (std::size_t s = 0; s < strips; ++s)
        for (std::size_t k = 0; k < 4; ++k) {
            double offset = k < 2 ? -x[k] : x[k - 2];
            place[4 * s + k] = (static_cast<double>(s) + 0.5 + 0.5 * offset) / strips;
            weight[4 * s + k] = 0.5 * w[k % 2] / strips;
        }
    double sum = 0;
    for (std::size_t i = 0; i < place.size(); ++i)
        for (std::size_t j = 0; j < place.size(); ++j)
            sum += weight[i] * weight[j] * length(area_vector(place[i], place[j]));
    return sum;
}

// Reshetov 2019, "Cool Patches: A Geometric Approach to Ray/Bilinear Patch Intersections": for a hit, the ray
// and the line of constant u must lie in one plane, which is a quadratic equation for u.
bool BilinearPatch::intersect(Vec3d o, Vec3d d, double tmax, Hit& hit) const {
    Vec3d q00 = p00 - o, q10 = p10 - o;
    // Volume spanned by d, the line's start and its direction: a + b u + c u^2.
    double a = dot(cross(q00, d), p01 - p00);
    double c = dot(cross(p10 - p00, p01 - p11), d);
    double b = dot(cross(q10, d), p11 - p10) - a - c;
    double discriminant = b * b - 4 * a * c;
    if (!(discriminant >= 0)) return false;
    // One of the two is always without cancellation; for a flat patch (c = 0) the first is infinite and falls
    // out.
    double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
    bool found = hit_on_line(o, d, q / c, tmax, hit);
    if (found) tmax = hit.t;
    return hit_on_line(o, d, a / q, tmax, hit) || found;
}

bool BilinearPatch::hit_on_line(Vec3d o, Vec3d d, double u, double tmax, Hit& hit) const {
    // Neighbouring patches compute their common edge differently; this closes the gap of a few roundings.
    constexpr double slack = 1e-12;
    if (!(u >= -slack && u <= 1 + slack)) return false;
    u = std::clamp(u, 0.0, 1.0);
    Vec3d from = start(u) - o, along = sweep(u);
    // t d = from + v along, crossed with either side.
    Vec3d n = cross(d, along);
    double scale = 1 / dot(n, n);
    double v = dot(cross(from, d), n) * scale, t = dot(cross(from, along), n) * scale;
    // A ray that leaves the patch must not meet it again: what the products above lose to rounding, which
    // grows with the patch's whole extent, is no distance.
    double least = 64 * std::numeric_limits<double>::epsilon() *
                   (length(from) + length(along) + length(p10 - p00)) * std::sqrt(dot(along, along) * scale);
    if (!(v >= -slack && v <= 1 + slack) || !(t > least && t < tmax)) return false;
    hit = {t, u, std::clamp(v, 0.0, 1.0)};
    return true;
}

} // namespace alhazen
