#include "sdf/tessellate.h"

#include "base/threads.h"

namespace alhazen {

namespace {

struct Cell {
    Vec3d lo;
    double size;
};

Vec3d corner(int i) {
    return {static_cast<double>(i & 1), static_cast<double>(i >> 1 & 1), static_cast<double>(i >> 2)};
}

// The cells that many levels further down in which there may be surface.
void descend(const PlacedSdf& field, const Cell& cell, int levels, std::vector<Cell>& found) {
    double half = 0.5 * cell.size;
    // The field cannot change its sign within its own value.
    if (std::abs(field.value(cell.lo + Vec3d(half))) > half * std::sqrt(3.0) * (1 + 1e-9)) return;
    if (levels == 0) return found.push_back(cell);
    for (int i = 0; i < 8; ++i) descend(field, {cell.lo + corner(i) * half, half}, levels - 1, found);
}

void march_tetrahedron(const std::array<Vec3d, 4>& p, const std::array<double, 4>& f,
                       const MoveToSurface& move, std::vector<SdfTriangle>& out) {
    std::array<std::size_t, 4> inside{}, outside{};
    std::size_t in = 0, off = 0;
    for (std::size_t c = 0; c < 4; ++c) {
        if (f[c] < 0)
            inside[in++] = c;
        else
            outside[off++] = c;
    }
    if (in == 0 || off == 0) return;
    auto between = [&](std::size_t a, std::size_t b) {
        return move(p[a] + (p[b] - p[a]) * (f[a] / (f[a] - f[b])));
    };
    if (in == 2) {
        Vec3d a = between(inside[0], outside[0]), b = between(inside[0], outside[1]);
        Vec3d c = between(inside[1], outside[0]), d = between(inside[1], outside[1]);
        out.push_back({a, b, c});
        out.push_back({b, d, c});
    } else {
        const auto& one = in == 1 ? inside : outside;
        const auto& three = in == 1 ? outside : inside;
        out.push_back({between(one[0], three[0]), between(one[0], three[1]), between(one[0], three[2])});
    }
}

} // namespace

void march_cell(Vec3d lo, double size, const std::array<double, 8>& f, const MoveToSurface& move,
                std::vector<SdfTriangle>& out) {
    auto inside = std::count_if(f.begin(), f.end(), [](double v) { return v < 0; });
    if (inside == 0 || inside == 8) return;
    // Six tetrahedra around the diagonal from corner 0 to corner 7 (Kuhn).
    static constexpr std::size_t paths[6][2] = {{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}};
    for (const auto& path : paths) {
        const std::array<std::size_t, 4> corners{0, path[0], path[1], 7};
        std::array<Vec3d, 4> p;
        std::array<double, 4> v{};
        for (std::size_t i = 0; i < 4; ++i) {
            p[i] = lo + corner(static_cast<int>(corners[i])) * size;
            v[i] = f[corners[i]];
        }
        march_tetrahedron(p, v, move, out);
    }
}

Vec3d move_to_surface(const PlacedSdf& field, Vec3d p, double reach) {
    Vec3d start = p, best = p;
    double least = Box::far;
    for (int i = 0; i < 12; ++i) {
        Dual f = field.value(dual_point(p));
        if (std::abs(f.v) < least) {
            least = std::abs(f.v);
            best = p;
        }
        double g2 = dot(f.d, f.d);
        if (f.v == 0 || !(g2 > 1e-12)) break;
        p -= f.d * (f.v / g2);
        if (!(length(p - start) < reach)) break;
    }
    return best;
}

std::vector<SdfTriangle> tessellate(const PlacedSdf& field, int levels) {
    double size = max_component(field.bounds().size());
    // Not quite centred, so that planes of symmetry do not run along the cells' sides.
    Cell root{field.bounds().centre() - Vec3d(0.51 * size) - Vec3d{0.0031, 0.0017, 0.0023} * size,
              1.03 * size};
    std::vector<Cell> blocks;
    int coarse = std::min(levels, 3);
    descend(field, root, coarse, blocks);
    std::vector<std::vector<SdfTriangle>> parts(blocks.size());
    parallel_ranges(blocks.size(), 1, [&](std::size_t i, std::size_t) {
        std::vector<Cell> cells;
        descend(field, blocks[i], levels - coarse, cells);
        for (const Cell& cell : cells) {
            std::array<double, 8> f{};
            for (std::size_t k = 0; k < 8; ++k)
                f[k] = field.value(cell.lo + corner(static_cast<int>(k)) * cell.size);
            march_cell(
                cell.lo, cell.size, f, [&](Vec3d p) { return move_to_surface(field, p, 0.5 * cell.size); },
                parts[i]);
        }
    });
    std::vector<SdfTriangle> all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

} // namespace alhazen
