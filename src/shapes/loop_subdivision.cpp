#include "shapes/loop_subdivision.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <tuple>

#include <fmt/format.h>

#include "base/messages.h"

namespace alhazen {

namespace {

constexpr double pi_double = 3.14159265358979323846;

// How much each neighbour counts for an inner vertex of n neighbours, by Warren's formula.
double neighbour_weight(int n) {
    return n == 3 ? 3.0 / 16 : 3.0 / (8 * n);
}

} // namespace

LoopSurface::LoopSurface(std::vector<Vec3> positions, const std::vector<int>& indices)
    : positions_(std::move(positions)), corners_(indices) {
    join_edges();
    if (problem_.empty()) find_fans();
}

void LoopSurface::join_edges() {
    struct Side {
        int lo, hi, half_edge;
    };
    std::vector<Side> sides;
    sides.reserve(corners_.size());
    for (int h = 0; h < static_cast<int>(corners_.size()); ++h) {
        const int a = from(h), b = to(h);
        if (a == b) {
            problem_ = fmt::format("the {} triangle has vertex {} twice",
                                   ordinal(static_cast<std::size_t>(h / 3) + 1), a);
            return;
        }
        sides.push_back({std::min(a, b), std::max(a, b), h});
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.lo, a.hi, a.half_edge) < std::tie(b.lo, b.hi, b.half_edge);
    });
    twins_.assign(corners_.size(), none);
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t end = i + 1;
        while (end < sides.size() && sides[end].lo == sides[i].lo && sides[end].hi == sides[i].hi) ++end;
        if (end - i > 2) {
            problem_ = fmt::format(
                "the edge between vertices {} and {} belongs to {} triangles; at most two are possible",
                sides[i].lo, sides[i].hi, end - i);
            return;
        }
        if (end - i == 2) {
            const int a = sides[i].half_edge, b = sides[i + 1].half_edge;
            if (from(a) == from(b)) {
                problem_ =
                    fmt::format("the triangles at the edge between vertices {} and {} go round in opposite "
                                "directions; all must go round the same way",
                                sides[i].lo, sides[i].hi);
                return;
            }
            twins_[static_cast<std::size_t>(a)] = b;
            twins_[static_cast<std::size_t>(b)] = a;
        }
        i = end;
    }
}

void LoopSurface::find_fans() {
    first_.assign(positions_.size(), none);
    std::vector<int> leaving(positions_.size(), 0);
    for (int h = 0; h < static_cast<int>(corners_.size()); ++h) {
        const auto v = static_cast<std::size_t>(from(h));
        ++leaving[v];
        // The boundary's half edge is the first that a walk counter-clockwise meets.
        if (first_[v] == none || twin(h) == none) first_[v] = h;
    }
    std::vector<int> around;
    for (int v = 0; v < static_cast<int>(positions_.size()); ++v) {
        if (first_[static_cast<std::size_t>(v)] == none) continue;
        ring(v, around);
        const int triangles = static_cast<int>(around.size()) - (is_boundary(v) ? 1 : 0);
        if (triangles == leaving[static_cast<std::size_t>(v)]) continue;
        problem_ = fmt::format("vertex {} joins parts of the surface that have no edge in common there", v);
        return;
    }
}

void LoopSurface::ring(int vertex, std::vector<int>& around) const {
    around.clear();
    const int start = first_[static_cast<std::size_t>(vertex)];
    if (start == none) return;
    int h = start;
    if (twin(h) == none) around.push_back(to(h));
    do {
        around.push_back(from(previous(h)));
        h = twin(previous(h));
    } while (h != none && h != start);
}

template <class Inner>
std::vector<Vec3> LoopSurface::blend(float boundary, Inner inner) const {
    std::vector<Vec3> blended(positions_);
    std::vector<int> around;
    for (int v = 0; v < static_cast<int>(positions_.size()); ++v) {
        ring(v, around);
        if (around.empty()) continue;
        Vec3d sum;
        double weight = static_cast<double>(boundary);
        int n = 2;
        if (is_boundary(v)) {
            sum = position(around.front()) + position(around.back());
        } else {
            n = static_cast<int>(around.size());
            weight = inner(n);
            for (int neighbour : around) sum += position(neighbour);
        }
        blended[static_cast<std::size_t>(v)] = Vec3(position(v) * (1 - n * weight) + sum * weight);
    }
    return blended;
}

void LoopSurface::refine() {
    std::vector<Vec3> positions = blend(1.0f / 8, neighbour_weight);
    // A vertex on each edge.
    std::vector<int> middle(corners_.size());
    for (int h = 0; h < static_cast<int>(corners_.size()); ++h) {
        const int other = twin(h);
        if (other != none && other < h) {
            middle[static_cast<std::size_t>(h)] = middle[static_cast<std::size_t>(other)];
            continue;
        }
        middle[static_cast<std::size_t>(h)] = static_cast<int>(positions.size());
        const Vec3d ends = position(from(h)) + position(to(h));
        positions.push_back(other == none ? Vec3(ends * 0.5)
                                          : Vec3(ends * (3.0 / 8) + (position(from(previous(h))) +
                                                                     position(from(previous(other)))) *
                                                                        (1.0 / 8)));
    }
    // Triangle f becomes 4 f + k at its corner k, and 4 f + 3 in the middle; of the former, corner k and the
    // half edges k and k + 2 lie on the old ones.
    std::vector<int> corners(4 * corners_.size()), twins(4 * corners_.size(), none);
    auto child = [](int f, int k, int edge) {
        return static_cast<std::size_t>(3 * (4 * f + k % 3) + edge % 3);
    };
    auto inner = [](int f, int edge) { return static_cast<std::size_t>(3 * (4 * f + 3) + edge); };
    for (int h = 0; h < static_cast<int>(corners_.size()); ++h) {
        const int f = h / 3, k = h % 3, m = middle[static_cast<std::size_t>(h)];
        corners[child(f, k, k)] = from(h);
        corners[child(f, k, k + 1)] = m;
        corners[child(f, k + 1, k)] = m;
        corners[inner(f, k)] = m;
        // Between this half edge's middle and the next one's.
        const std::size_t a = child(f, k + 1, k + 2), b = inner(f, k);
        twins[a] = static_cast<int>(b);
        twins[b] = static_cast<int>(a);
        if (twin(h) == none) continue;
        const int g = twin(h) / 3, l = twin(h) % 3;
        twins[child(f, k, k)] = static_cast<int>(child(g, l + 1, l));
        twins[child(f, k + 1, k)] = static_cast<int>(child(g, l, l));
    }
    positions_ = std::move(positions);
    corners_ = std::move(corners);
    twins_ = std::move(twins);
    find_fans();
}

void LoopSurface::move_to_limit() {
    // At boundaries the limit would be at 1/6; this is Hoppe's rule, as in pbrt-v4.
    positions_ = blend(1.0f / 5, [](int n) { return 1 / (n + 3 / (8 * neighbour_weight(n))); });
}

std::vector<Vec3> LoopSurface::normals() const {
    std::vector<Vec3> normals(positions_.size());
    std::vector<int> around;
    for (int v = 0; v < static_cast<int>(positions_.size()); ++v) {
        ring(v, around);
        if (around.empty()) continue;
        const int n = static_cast<int>(around.size());
        auto p = [&](int i) { return position(around[static_cast<std::size_t>(i)]); };
        Vec3d along, across;
        if (!is_boundary(v)) {
            for (int i = 0; i < n; ++i) {
                along += p(i) * std::cos(2 * pi_double * i / n);
                across += p(i) * std::sin(2 * pi_double * i / n);
            }
            along = -along;
        } else {
            along = p(n - 1) - p(0);
            if (n == 2)
                across = p(0) + p(1) - position(v) * 2.0;
            else if (n == 3)
                across = p(1) - position(v);
            else if (n == 4)
                across = (p(1) + p(2)) * 2.0 - p(0) - p(3) - position(v) * 2.0;
            else {
                const double theta = pi_double / (n - 1);
                across = (p(0) + p(n - 1)) * -std::sin(theta);
                for (int i = 1; i < n - 1; ++i)
                    across += p(i) * ((2 - 2 * std::cos(theta)) * std::sin(i * theta));
            }
        }
        normals[static_cast<std::size_t>(v)] = Vec3(cross(along, across));
    }
    return normals;
}

} // namespace alhazen
