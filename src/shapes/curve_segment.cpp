#include "shapes/curve_segment.h"

#include "base/frame.h"

namespace alhazen {

namespace {

float dot2(Vec3 a, Vec3 b) {
    return a.x * b.x + a.y * b.y;
}

// The ray in its own space: it starts at the origin and goes along +z; the strand's ends lie side by side
// along x, so that the strand is low in y.
struct RaySpace {
    Frame frame;
    Vec3 origin;
    float speed = 0; // of the ray: z per t

    RaySpace(const Ray& ray, Vec3 along) : origin(ray.o), speed(length(ray.d)) {
        const Vec3 z = ray.d / speed, side = cross(z, along);
        const float l = length(side);
        if (!(l > 0)) {
            frame = Frame::from_z(z);
            return;
        }
        const Vec3 y = side / l;
        frame = {cross(y, z), y, z};
    }
    Vec3 point(Vec3 p) const { return frame.to_local(p - origin); }
    // Whether all control points are farther than that on one side in y: the test that most rays fail.
    bool passes_beside(const CubicBezier& c, float distance) const {
        float lo = infinity, hi = -infinity;
        for (Vec3 p : {c[0], c[1], c[2]}) { // the last one's y is the first one's
            const float y = dot(p - origin, frame.y);
            lo = std::min(lo, y);
            hi = std::max(hi, y);
        }
        return lo > distance * 1.001f || hi < -distance * 1.001f;
    }
};

// The search for the nearest hit of one strand in the ray's space.
class CurveSearch {
  public:
    CurveSearch(const CurveSegment& segment, CurveType type, const RaySpace& space, float tmax)
        : segment_(segment), type_(type), space_(space), tmax_(tmax) {}

    // c is the part of the curve from u0 to u1.
    bool run(const CubicBezier& c, float u0, float u1) {
        if (!may_meet(c, u0, u1)) return false;
        search(c, u0, u1, depth(c, std::max(segment_.width(u0), segment_.width(u1))));
        return found_;
    }
    void store(Intersection& hit) const {
        hit.t = tmax_;
        hit.u = u_;
        hit.v = v_;
    }

  private:
    // Whether the box around the band holds a point of the ray.
    bool may_meet(const CubicBezier& c, float u0, float u1) const {
        const float r = 0.5f * std::max(segment_.width(u0), segment_.width(u1));
        const Vec3 lo = min(min(c[0], c[1]), min(c[2], c[3])), hi = max(max(c[0], c[1]), max(c[2], c[3]));
        return lo.x <= r && hi.x >= -r && lo.y <= r && hi.y >= -r && lo.z - r <= tmax_ * space_.speed &&
               hi.z + r >= 0;
    }

    // How often to halve the curve until each part is nearly straight: each time, the distance between the
    // curve and its chord becomes a quarter.
    static int depth(const CubicBezier& c, float width) {
        constexpr float tolerance = 1.0f / 16; // of the width
        constexpr int deepest = 10;
        const Vec3 a = c[0] - c[1] * 2.0f + c[2], b = c[1] - c[2] * 2.0f + c[3];
        float bend = 0.75f * std::sqrt(std::max(dot2(a, a), dot2(b, b)));
        int levels = 0;
        for (; bend > tolerance * width && levels < deepest; bend *= 0.25f) ++levels;
        return levels;
    }

    void search(const CubicBezier& c, float u0, float u1, int levels) {
        if (levels == 0) return test(c, u0, u1);
        const auto [first, second] = halve(c);
        const float middle = 0.5f * (u0 + u1);
        if (may_meet(first, u0, middle)) search(first, u0, middle, levels - 1);
        if (may_meet(second, middle, u1)) search(second, middle, u1, levels - 1);
    }

    // Where the ray, which is the origin in x and y, is nearest to a part of the curve that is nearly
    // straight. If its distance does not shrink inwards from both ends, it belongs to a neighbour or lies
    // beyond the strand's end.
    void test(const CubicBezier& c, float u0, float u1) {
        if (dot2(c[1] - c[0], c[0]) > 0 || dot2(c[3] - c[2], c[3]) < 0) return;
        const Vec3 chord = c[3] - c[0];
        const float chord2 = dot2(chord, chord);
        if (!(chord2 > 0)) return;
        float w = std::clamp(-dot2(c[0], chord) / chord2, 0.0f, 1.0f);
        Vec3 p = bezier_point(c, w);
        constexpr int newton_steps = 2;
        for (int i = 0; i < newton_steps; ++i) {
            const Vec3 d = bezier_derivative(c, w);
            const float slope = dot2(d, d) + dot2(p, bezier_second_derivative(c, w));
            if (!(slope > 0)) break;
            const float better = std::clamp(w - dot2(p, d) / slope, 0.0f, 1.0f);
            const Vec3 q = bezier_point(c, better);
            if (!(dot2(q, q) < dot2(p, p))) break; // about a centre of curvature steps are wild
            w = better;
            p = q;
        }
        accept(p, lerp(w, u0, u1), bezier_derivative(c, w));
    }

    // A point of the curve that is the nearest to the ray, and the tangent there.
    void accept(Vec3 p, float u, Vec3 tangent) {
        const float width = segment_.seen_width(type_, u, space_.frame.z);
        const float distance2 = dot2(p, p);
        if (!(distance2 <= sqr(0.5f * width)) || !(width > 0)) return;
        const float t = p.z / space_.speed;
        if (!(t > 0) || !(t < tmax_)) return;
        found_ = true;
        tmax_ = t;
        u_ = u;
        // The side of the curve that the ray passes on, seen along it.
        const float side = p.x * tangent.y - p.y * tangent.x;
        v_ = 0.5f + std::copysign(std::sqrt(distance2) / width, side);
    }

    const CurveSegment& segment_;
    CurveType type_;
    const RaySpace& space_;
    float tmax_;
    float u_ = 0, v_ = 0;
    bool found_ = false;
};

} // namespace

Vec3 CurveSegment::ribbon_normal(float u) const {
    const float cosine = std::clamp(dot(normal0, normal1), -1.0f, 1.0f), angle = std::acos(cosine);
    const float sine = std::sin(angle);
    // Parallel, or opposite, which is the same ribbon.
    if (!(sine > 1e-4f)) return normal0;
    return (normal0 * std::sin((1 - u) * angle) + normal1 * std::sin(u * angle)) / sine;
}

float CurveSegment::seen_width(CurveType type, float u, Vec3 direction) const {
    const float w = width(u);
    return type == CurveType::ribbon ? w * abs_dot(ribbon_normal(u), direction) : w;
}

bool CurveSegment::intersect(const Ray& ray, CurveType type, float u0, float u1, Intersection& hit) const {
    const CubicBezier part = bezier_part(points, u0, u1);
    const RaySpace space(ray, part[3] - part[0]);
    if (!(space.speed > 0) || space.passes_beside(part, 0.5f * std::max(width(u0), width(u1)))) return false;
    CurveSearch search(*this, type, space, ray.tmax);
    if (!search.run({space.point(part[0]), space.point(part[1]), space.point(part[2]), space.point(part[3])},
                    u0, u1))
        return false;
    search.store(hit);
    return true;
}

// The band's dpdv lies to the left of dpdu as the ray sees it. A tube's is turned about dpdu by up to 90
// degrees at its rims (by an angle linear in v, as in pbrt-v4), where the normal thus points sideways.
CurveSegment::Tangents CurveSegment::tangents(const Ray& ray, CurveType type, float u, float v) const {
    const Vec3 z = normalize(ray.d);
    Vec3 dpdu = bezier_derivative(points, u);
    // Coinciding control points: their chord shows the way.
    if (!(length_squared(dpdu) > 0)) dpdu = points[3] - points[0];
    const float w = seen_width(type, u, z);
    auto scaled = [&](Vec3 d, Vec3 otherwise) {
        const float l = length(d);
        return (l > 0 ? d / l : otherwise) * w;
    };
    const Frame around = Frame::from_z(normalize(dpdu));
    if (type == CurveType::ribbon) return {dpdu, scaled(cross(ribbon_normal(u), dpdu), around.x)};
    Vec3 dpdv = scaled(cross(z, dpdu), around.x);
    if (type == CurveType::cylinder) {
        const float angle = pi * (v - 0.5f);
        dpdv = dpdv * std::cos(angle) - cross(normalize(dpdu), dpdv) * std::sin(angle);
    }
    return {dpdu, dpdv};
}

} // namespace alhazen
