#include "shapes/shape.h"

#include "accel/primitives.h"
#include "shapes/triangle_mesh.h"

namespace alhazen {

namespace {

// A density per area, seen from a point that is v away on a surface with normal n, per steradian (Pharr,
// Jakob and Humphreys 2023, equation 6.8). 0 where the surface is seen edge-on: no finite density describes
// that. Next to edge-on, a sample and the hit of the ray towards it may differ by factors, since the ray's
// rounding changes the cosine; each has the density of its own point.
float per_steradian(float area_pdf, Vec3d v, Vec3 n) {
    double d2 = dot(v, v);
    double cosine = std::abs(dot(v, Vec3d(n))) / std::sqrt(d2);
    auto pdf = static_cast<float>(static_cast<double>(area_pdf) * d2 / cosine);
    return std::isfinite(pdf) ? pdf : 0;
}

} // namespace

std::optional<ShapeSample> Shape::sample_from(std::uint32_t primitive, Vec3 reference, Vec2 u) const {
    ShapeSample s = sample(primitive, u);
    s.pdf = per_steradian(s.pdf, Vec3d(s.p) - Vec3d(reference), s.ng);
    if (!(s.pdf > 0)) return std::nullopt;
    return s;
}

bool Shape::tessellate(double /*tolerance*/, const TriangleSink& out) const {
    const TriangleMesh* mesh = triangles();
    if (!mesh) return false;
    for (std::uint32_t i = 0; i < mesh->primitive_count(); ++i) {
        auto [a, b, c] = mesh->vertices(i);
        if (mesh->is_turned()) std::swap(b, c);
        out(Corners{a, b, c});
    }
    return true;
}

float Shape::pdf_from(std::uint32_t primitive, Vec3 reference, const Hit& hit, Vec3 /*wi*/) const {
    return per_steradian(1 / area(primitive), Vec3d(hit.p) - Vec3d(reference), hit.ng);
}

} // namespace alhazen
