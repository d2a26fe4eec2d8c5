#include "media/clear_cells.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

ClearCells::ClearCells(const Medium& medium) : medium_(medium) {
    if (medium.majorants().is_everywhere()) return;
    const Vec3i n = medium.majorants().cells();
    clear_.assign(index({n.x - 1, n.y - 1, n.z - 1}) + 1, 1);
}

void ClearCells::add_surface(const Bounds3& box) {
    if (clear_.empty() || box.empty()) return;
    const MajorantGrid& grid = medium_.majorants();
    const Vec3i n = grid.cells();
    const Bounds3 reach = medium_.to_medium(box);
    Vec3i first, last;
    for (int i = 0; i < 3; ++i) {
        // A ray's place in a cell, and a hit's along the ray, are known to within rounding only.
        constexpr float pad = 1e-3f;
        const auto cells = static_cast<float>(n[i]);
        const float per_length = cells / (grid.box().hi[i] - grid.box().lo[i]);
        const float lo = (reach.lo[i] - grid.box().lo[i]) * per_length - pad;
        const float hi = (reach.hi[i] - grid.box().lo[i]) * per_length + pad;
        if (hi < 0 || lo >= cells) return;
        first[i] = static_cast<int>(std::max(lo, 0.0f));
        last[i] = static_cast<int>(std::min(hi, cells - 1));
    }
    for (int z = first.z; z <= last.z; ++z)
        for (int y = first.y; y <= last.y; ++y)
            std::fill_n(clear_.begin() + static_cast<std::ptrdiff_t>(index({first.x, y, z})),
                        last.x - first.x + 1, std::uint8_t(0));
}

} // namespace alhazen
