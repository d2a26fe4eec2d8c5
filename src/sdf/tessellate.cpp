#include "sdf/tessellate.h"

#include "base/threads.h"

namespace alhazen {

namespace {

struct Cell {
    Vec3d lo;
    double size;
};

class Marcher {
  public:
    explicit Marcher(const PlacedSdf& field) : field_(field) {}

    // The cells of that many further levels in which there may be surface.
    void descend(const Cell& cell, int levels, std::vector<Cell>& found) const {
        double half = 0.5 * cell.size;
        // The field cannot change its sign within its own value.
        if (std::abs(field_.value(cell.lo + Vec3d(half))) > half * std::sqrt(3.0) * (1 + 1e-9)) return;
        if (levels == 0) return found.push_back(cell);
        for (int i = 0; i < 8; ++i) descend({cell.lo + corner(i) * half, half}, levels - 1, found);
    }

    void march(const Cell& cell, std::vector<SdfTriangle>& out) const {
        std::array<Vec3d, 8> p;
        std::array<double, 8> f{};
        bool some_inside = false, some_outside = false;
        for (std::size_t i = 0; i < 8; ++i) {
            p[i] = cell.lo + corner(static_cast<int>(i)) * cell.size;
            f[i] = field_.value(p[i]);
            (f[i] < 0 ? some_inside : some_outside) = true;
        }
        if (!some_inside || !some_outside) return;
        // Six tetrahedra around the diagonal from corner 0 to corner 7 (Kuhn).
        static constexpr std::size_t paths[6][2] = {{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}};
        for (const auto& path : paths) tetrahedron(p, f, {0, path[0], path[1], 7}, cell.size, out);
    }

  private:
    static Vec3d corner(int i) {
        return {static_cast<double>(i & 1), static_cast<double>(i >> 1 & 1), static_cast<double>(i >> 2)};
    }

    void tetrahedron(const std::array<Vec3d, 8>& p, const std::array<double, 8>& f,
                     const std::array<std::size_t, 4>& corners, double size,
                     std::vector<SdfTriangle>& out) const {
        std::array<std::size_t, 4> inside{}, outside{};
        std::size_t in = 0, off = 0;
        for (std::size_t c : corners) {
            if (f[c] < 0)
                inside[in++] = c;
            else
                outside[off++] = c;
        }
        if (in == 0 || off == 0) return;
        auto between = [&](std::size_t a, std::size_t b) {
            Vec3d q = p[a] + (p[b] - p[a]) * (f[a] / (f[a] - f[b]));
            return move_to_surface(field_, q, 0.5 * size);
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

    const PlacedSdf& field_;
};

} // namespace

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
    Marcher marcher(field);
    Vec3d size = field.bounds().size();
    // Not quite centred, so that planes of symmetry do not run along the cells' sides.
    Cell root{field.bounds().centre() - Vec3d(0.5 * max_component(size) * 1.02) -
                  Vec3d{0.0031, 0.0017, 0.0023} * max_component(size),
              1.03 * max_component(size)};
    std::vector<Cell> blocks;
    int coarse = std::min(levels, 3);
    marcher.descend(root, coarse, blocks);
    std::vector<std::vector<SdfTriangle>> parts(blocks.size());
    parallel_ranges(blocks.size(), 1, [&](std::size_t i, std::size_t) {
        std::vector<Cell> cells;
        marcher.descend(blocks[i], levels - coarse, cells);
        for (const Cell& cell : cells) marcher.march(cell, parts[i]);
    });
    std::vector<SdfTriangle> all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

} // namespace alhazen
