#include "sdf/box.h"

namespace alhazen {

// Interval arithmetic, in which 0 times infinity is 0: an axis that does not count does not reach far.
Box transformed(const Matrix4& m, const Box& box) {
    Box out;
    for (int i = 0; i < 3; ++i) {
        auto r = static_cast<std::size_t>(i);
        double lo = m.m[r][3], hi = m.m[r][3];
        for (int j = 0; j < 3; ++j) {
            double a = m.m[r][static_cast<std::size_t>(j)];
            if (a == 0) continue;
            lo += std::min(a * box.lo[j], a * box.hi[j]);
            hi += std::max(a * box.lo[j], a * box.hi[j]);
        }
        // Some roundings outward.
        out.lo[i] = lo - std::abs(lo) * 1e-14;
        out.hi[i] = hi + std::abs(hi) * 1e-14;
    }
    return out;
}

} // namespace alhazen
