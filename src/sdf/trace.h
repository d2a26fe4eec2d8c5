/// Sphere tracing: where a ray first crosses the surface of a signed distance field (Hart 1996), with
/// over-relaxed steps (Keinert et al. 2014, "Enhanced Sphere Tracing", section 3.1).
#pragma once

#include <optional>

#include "base/vec.h"

namespace alhazen {

/// A stretch of a line of unit direction, and the least step along it. Surfaces that the line enters and
/// leaves again within a least step may be missed.
struct SphereTrace {
    double begin = 0, end = 0;
    double least_step = 0;
};

namespace sphere_trace_detail {

constexpr int most_steps = 1 << 14;
constexpr double relaxation = 1.6;
/// Where the field stays below the least step, as along a surface that is grazed, steps grow by this.
constexpr double growth = 1.02, most_growth = 100;

/// A zero between a and b, where g is positive and not: the Illinois form of false position, kept honest by
/// bisection. Ends on the side where g is positive, within some roundings of the zero.
template <class Field>
double refine(const Field& g, double a, double ga, double b, double gb, double magnitude) {
    double tolerance = 4e-16 * magnitude;
    for (int i = 0; i < 200 && b - a > tolerance && gb != 0; ++i) {
        double width = b - a;
        double s = i % 3 == 2 ? 0.5 * (a + b) : a + width * (ga / (ga - gb));
        s = std::min(std::max(s, a + 0.25 * tolerance), b - 0.25 * tolerance);
        double gs = g(s);
        if (gs > 0) {
            a = s;
            ga = gs;
            gb *= 0.5;
        } else {
            b = s;
            gb = gs;
            ga *= 0.5;
        }
    }
    return gb == 0 ? b : a;
}

} // namespace sphere_trace_detail

/// The least s in [begin, end] at which the field changes its sign along the line; field(s) must be
/// 1-Lipschitz. nullopt when there is none.
template <class Field>
std::optional<double> first_crossing(const Field& field, const SphereTrace& line, double magnitude) {
    using namespace sphere_trace_detail;
    double s = line.begin, first = field(s);
    bool outside = first >= 0;
    auto g = [&](double at) {
        double f = field(at);
        return outside ? f : -f;
    };
    double r = std::abs(first), omega = relaxation, least = line.least_step;
    for (int i = 0; i < most_steps && s < line.end; ++i) {
        double relaxed = omega * r;
        bool is_relaxed = relaxed > least;
        double step = std::max(relaxed, least), next = s + step, here = g(next);
        // The spheres must overlap, or something may stand between them.
        if (is_relaxed && omega > 1 && r + here < step) {
            omega = 1;
            continue;
        }
        if (!(here > 0)) {
            double root = refine(g, s, r, next, here, magnitude + next);
            if (!(root <= line.end)) return std::nullopt;
            return root;
        }
        least = is_relaxed ? line.least_step : std::min(least * growth, line.least_step * most_growth);
        omega = relaxation;
        s = next;
        r = here;
    }
    return std::nullopt;
}

} // namespace alhazen
