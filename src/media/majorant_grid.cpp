#include "media/majorant_grid.h"

#include <algorithm>

#include "base/threads.h"

namespace alhazen {

MajorantGrid::MajorantGrid(const Bounds3& box, Vec3i cells,
                           const std::function<float(const Bounds3&)>& largest)
    : box_(box), cells_(cells) {
    const auto count = [](int n) { return static_cast<std::size_t>(n); };
    densities_.resize(count(cells.x) * count(cells.y) * count(cells.z));
    const Vec3 diagonal = box.diagonal();
    for (int i = 0; i < 3; ++i) {
        cell_size_[i] = diagonal[i] / static_cast<float>(cells[i]);
        cells_per_length_[i] = 1 / cell_size_[i];
    }
    const Vec3 size = cell_size_;
    parallel_for(count(cells.z), 1, [&](std::size_t layer) {
        const int z = static_cast<int>(layer);
        for (int y = 0; y < cells.y; ++y)
            for (int x = 0; x < cells.x; ++x) {
                const Vec3 corner{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
                // A ray's place in a cell is known to within rounding only.
                const Vec3 pad = size * 1e-3f;
                const Vec3 lo = box.lo + size * corner - pad, hi = box.lo + size * (corner + Vec3(1)) + pad;
                densities_[(layer * count(cells.y) + count(y)) * count(cells.x) + count(x)] =
                    largest({lo, hi});
            }
    });
}

MajorantWalk::MajorantWalk(const MajorantGrid& grid, const Ray& ray) : grid_(grid), end_(ray.tmax) {
    if (grid.is_everywhere()) return;
    const Bounds3& box = grid.box();
    // Infinite where the ray stays at one place along the axis, or as good as that.
    const Vec3 inverse_d{1 / ray.d.x, 1 / ray.d.y, 1 / ray.d.z};
    for (int i = 0; i < 3; ++i) {
        if (std::isinf(inverse_d[i])) {
            if (!(ray.o[i] >= box.lo[i] && ray.o[i] <= box.hi[i])) is_over_ = true;
            continue;
        }
        float in = (box.lo[i] - ray.o[i]) * inverse_d[i], out = (box.hi[i] - ray.o[i]) * inverse_d[i];
        if (in > out) std::swap(in, out);
        t_ = std::max(t_, in);
        end_ = std::min(end_, out);
    }
    is_over_ = is_over_ || !(t_ < end_);
    if (is_over_) return;
    const Vec3 &size = grid.cell_size(), &cells_per_length = grid.cells_per_length();
    for (int i = 0; i < 3; ++i) {
        const float place = (ray.o[i] + ray.d[i] * t_ - box.lo[i]) * cells_per_length[i];
        cell_[i] = std::clamp(static_cast<int>(place), 0, grid.cells()[i] - 1);
        step_[i] = ray.d[i] < 0 ? -1 : 1;
        next_t_[i] = delta_t_[i] = infinity;
        if (std::isinf(inverse_d[i])) continue;
        const float border = box.lo[i] + size[i] * static_cast<float>(cell_[i] + (ray.d[i] > 0 ? 1 : 0));
        next_t_[i] = (border - ray.o[i]) * inverse_d[i];
        delta_t_[i] = size[i] * std::abs(inverse_d[i]);
    }
}

void MajorantWalk::limit(float tmax) {
    end_ = std::min(end_, tmax);
    is_over_ = is_over_ || !(t_ < end_);
}

} // namespace alhazen
