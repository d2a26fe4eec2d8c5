#include "sdf/mesh_distance.h"

#include <cassert>

#include "accel/accel.h"
#include "base/threads.h"

namespace alhazen {

namespace {

struct Soup final : Primitives {
    const std::vector<Corners>& triangles;
    explicit Soup(const std::vector<Corners>& t) : triangles(t) {}
    std::uint32_t count() const override { return static_cast<std::uint32_t>(triangles.size()); }
    // As boxes: triangles without area are near things, too.
    PrimitiveKind kind(std::uint32_t) const override { return PrimitiveKind::custom; }
    Bounds3 bounds(std::uint32_t i) const override {
        const Corners& t = triangles[i];
        return {min(min(t.a, t.b), t.c), max(max(t.a, t.b), t.c)};
    }
    Corners corners(std::uint32_t i) const override { return triangles[i]; }
};

double distance2_to(const Bounds3& box, Vec3d p) {
    Vec3d out = max(max(Vec3d(box.lo) - p, p - Vec3d(box.hi)), Vec3d{});
    return dot(out, out);
}

/// Groups whose distance is at least so many radii are expanded.
constexpr double far_enough = 3;

// The solid angle of a triangle seen from the origin, signed by its orientation (van Oosterom and Strackee
// 1983).
double solid_angle(Vec3d a, Vec3d b, Vec3d c) {
    double la = length(a), lb = length(b), lc = length(c);
    double triple = dot(a, cross(b, c));
    double below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    return 2 * std::atan2(triple, below);
}

} // namespace

namespace {

// Of a triangle without area: the nearest point of its sides.
TrianglePoint nearest_on_sides(Vec3d a, Vec3d b, Vec3d c, Vec3d p) {
    auto along = [&](Vec3d from, Vec3d to) {
        Vec3d side = to - from;
        double length2 = dot(side, side);
        return length2 > 0 ? std::clamp(dot(p - from, side) / length2, 0.0, 1.0) : 0.0;
    };
    double ab = along(a, b), bc = along(b, c), ca = along(c, a);
    TrianglePoint best{a + (b - a) * ab, ab, 0};
    for (const TrianglePoint& other :
         {TrianglePoint{b + (c - b) * bc, 1 - bc, bc}, TrianglePoint{c + (a - c) * ca, 0, 1 - ca}})
        if (length(other.p - p) < length(best.p - p)) best = other;
    return best;
}

} // namespace

TrianglePoint nearest_on_triangle(Vec3d a, Vec3d b, Vec3d c, Vec3d p) {
    Vec3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    if (!(length_squared(cross(ab, ac)) > 1e-24 * dot(ab, ab) * dot(ac, ac)))
        return nearest_on_sides(a, b, c, p);
    double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
           d6 = dot(ac, cp);
    if (d1 <= 0 && d2 <= 0) return {a, 0, 0};
    if (d3 >= 0 && d4 <= d3) return {b, 1, 0};
    if (d6 >= 0 && d5 <= d6) return {c, 0, 1};
    double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        double t = d1 / (d1 - d3);
        return {a + ab * t, t, 0};
    }
    if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        double t = d2 / (d2 - d6);
        return {a + ac * t, 0, t};
    }
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        double t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {b + (c - b) * t, 1 - t, t};
    }
    double sum = va + vb + vc;
    return {a + ab * (vb / sum) + ac * (vc / sum), vb / sum, vc / sum};
}

MeshDistance::MeshDistance(std::vector<Corners> triangles, Asked asked) : triangles_(std::move(triangles)) {
    std::erase_if(triangles_,
                  [](const Corners& t) { return !is_finite(t.a) || !is_finite(t.b) || !is_finite(t.c); });
    Soup soup(triangles_);
    tree_ = build_tree(soup, AccelChoice{"sah", "stack", {}});
    if (asked == Asked::insides) {
        moments_.resize(tree_.nodes.size());
        parallel_for(tree_.nodes.size(), 64, [&](std::size_t i) { measure(static_cast<std::uint32_t>(i)); });
    }
    for (const Corners& t : triangles_)
        for (Vec3 p : {t.a, t.b, t.c}) bounds_.extend(p);
}

void MeshDistance::measure(std::uint32_t node) {
    const Tree::Node& n = tree_.nodes[node];
    Moments m{};
    double area = 0;
    Vec3d box_centre = (Vec3d(n.bounds.lo) + Vec3d(n.bounds.hi)) * 0.5;
    auto add = [&](double a, Vec3d c) {
        area += a;
        m.centre += c * a;
    };
    // Where all triangles of the node stand in the order: leaves follow each other there.
    std::uint32_t last = node;
    while (!tree_.nodes[last].is_leaf()) last = tree_.nodes[last].first_or_right;
    std::uint32_t first = node;
    while (!tree_.nodes[first].is_leaf()) ++first;
    std::uint32_t begin = tree_.nodes[first].first_or_right,
                  end = tree_.nodes[last].first_or_right + tree_.nodes[last].count;
    auto each = [&](const auto& visit) {
        for (std::uint32_t i = begin; i < end; ++i) {
            const Corners& t = triangles_[tree_.order[i]];
            Vec3d a(t.a), b(t.b), c(t.c);
            visit(cross(b - a, c - a) * 0.5, (a + b + c) * (1.0 / 3));
        }
    };
    each([&](Vec3d n_area, Vec3d c) { add(length(n_area), c); });
    m.centre = area > 0 ? m.centre * (1 / area) : box_centre;
    each([&](Vec3d n_area, Vec3d c) {
        m.dipole += n_area;
        Vec3d off = c - m.centre;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) m.quadrupole[3 * i + j] += off[i] * n_area[j];
    });
    Vec3d reach = max(Vec3d(n.bounds.hi) - m.centre, m.centre - Vec3d(n.bounds.lo));
    m.radius = length(reach);
    moments_[node] = m;
}

std::optional<MeshDistance::Nearest> MeshDistance::nearest(Vec3d p, double limit) const {
    if (tree_.nodes.empty()) return std::nullopt;
    struct Entry {
        std::uint32_t node;
        double distance2;
    };
    std::array<Entry, Tree::max_depth + 1> stack;
    std::size_t size = 0;
    double best2 = limit * limit;
    std::optional<Nearest> best;
    stack[size++] = {0, distance2_to(tree_.nodes[0].bounds, p)};
    while (size > 0) {
        Entry entry = stack[--size];
        if (!(entry.distance2 < best2)) continue;
        const Tree::Node& node = tree_.nodes[entry.node];
        if (node.is_leaf()) {
            for (std::uint32_t i = 0; i < node.count; ++i) {
                std::uint32_t k = tree_.order[node.first_or_right + i];
                const Corners& t = triangles_[k];
                TrianglePoint at = nearest_on_triangle(Vec3d(t.a), Vec3d(t.b), Vec3d(t.c), p);
                double d2 = dot(at.p - p, at.p - p);
                if (!(d2 < best2)) continue;
                best2 = d2;
                best = Nearest{0, k, at};
            }
            continue;
        }
        Entry left{entry.node + 1, distance2_to(tree_.nodes[entry.node + 1].bounds, p)};
        Entry right{node.first_or_right, distance2_to(tree_.nodes[node.first_or_right].bounds, p)};
        if (left.distance2 < right.distance2) std::swap(left, right);
        stack[size++] = left;
        stack[size++] = right;
    }
    if (best) best->distance = std::sqrt(best2);
    return best;
}

double MeshDistance::winding_number(Vec3d p) const {
    if (tree_.nodes.empty()) return 0;
    assert(!moments_.empty());
    std::array<std::uint32_t, Tree::max_depth + 1> stack;
    std::size_t size = 0;
    double sum = 0;
    stack[size++] = 0;
    while (size > 0) {
        std::uint32_t at = stack[--size];
        const Tree::Node& node = tree_.nodes[at];
        const Moments& m = moments_[at];
        Vec3d d = m.centre - p;
        double d2 = dot(d, d);
        if (d2 > far_enough * far_enough * m.radius * m.radius) {
            double inverse = 1 / std::sqrt(d2), inverse3 = inverse * inverse * inverse, trace = 0, along = 0;
            for (int i = 0; i < 3; ++i) {
                trace += m.quadrupole[4 * i];
                for (int j = 0; j < 3; ++j) along += m.quadrupole[3 * i + j] * d[i] * d[j];
            }
            sum += inverse3 * (dot(d, m.dipole) + trace - 3 * along * inverse * inverse);
        } else if (node.is_leaf()) {
            for (std::uint32_t i = 0; i < node.count; ++i) {
                const Corners& t = triangles_[tree_.order[node.first_or_right + i]];
                sum += solid_angle(Vec3d(t.a) - p, Vec3d(t.b) - p, Vec3d(t.c) - p);
            }
        } else {
            stack[size++] = node.first_or_right;
            stack[size++] = at + 1;
        }
    }
    return sum / (4 * 3.14159265358979323846);
}

} // namespace alhazen
