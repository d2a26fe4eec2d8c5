#include "image/display.h"

namespace alhazen {

namespace {

int inside(int i, int n, Border border) {
    if (i >= 0 && i < n) return i;
    if (border == Border::clamp) return std::clamp(i, 0, n - 1);
    int period = 2 * n;
    i %= period;
    if (i < 0) i += period;
    return i < n ? i : period - 1 - i;
}

} // namespace

Plane filter_separable(const Plane& in, std::span<const float> horizontal, std::span<const float> vertical,
                       Border border) {
    int rx = static_cast<int>(horizontal.size()) / 2, ry = static_cast<int>(vertical.size()) / 2;
    Plane rows(in.width, in.height), out(in.width, in.height);
    // A row with its border on both sides, so that the inner loop needs no test.
    std::vector<float> padded(static_cast<std::size_t>(in.width + 2 * rx));
    for (int y = 0; y < in.height; ++y) {
        for (int x = -rx; x < in.width + rx; ++x)
            padded[static_cast<std::size_t>(x + rx)] = in.at(inside(x, in.width, border), y);
        for (std::size_t k = 0; k < horizontal.size(); ++k)
            for (int x = 0; x < in.width; ++x)
                rows.at(x, y) += horizontal[k] * padded[static_cast<std::size_t>(x) + k];
    }
    for (int y = 0; y < in.height; ++y)
        for (std::size_t k = 0; k < vertical.size(); ++k) {
            int source = inside(y + static_cast<int>(k) - ry, in.height, border);
            for (int x = 0; x < in.width; ++x) out.at(x, y) += vertical[k] * rows.at(x, source);
        }
    return out;
}

} // namespace alhazen
