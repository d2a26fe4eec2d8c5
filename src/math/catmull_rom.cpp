#include "math/catmull_rom.h"

#include <algorithm>
#include <vector>

namespace alhazen {

namespace {

/// Where a function that increases over [0, 1] has a value: Newton's steps within a shrinking interval.
template <class Function, class Slope>
float find_root(Function function, Slope slope, float guess, float value) {
    float lo = 0, hi = 1, t = std::clamp(guess, 0.0f, 1.0f);
    for (int i = 0; i < 40; ++i) {
        const float error = function(t) - value;
        (error < 0 ? lo : hi) = t;
        const float s = slope(t);
        float next = s > 0 ? t - error / s : -1;
        // Also for what is not a number.
        if (!(next > lo && next < hi)) next = 0.5f * (lo + hi);
        if (next == t || hi - lo < 1e-7f) break;
        t = next;
    }
    return t;
}

std::size_t piece_with(std::span<const float> increasing, float x) {
    const auto after = std::upper_bound(increasing.begin() + 1, increasing.end() - 1, x);
    return static_cast<std::size_t>(after - increasing.begin()) - 1;
}

} // namespace

SplineWeights spline_weights(std::span<const float> nodes, float x) {
    x = std::clamp(x, nodes.front(), nodes.back());
    const std::size_t i = piece_with(nodes, x), last = nodes.size() - 1;
    const float width = nodes[i + 1] - nodes[i], t = (x - nodes[i]) / width, t2 = t * t, t3 = t2 * t;
    std::array<float, 4> w{0, 2 * t3 - 3 * t2 + 1, 3 * t2 - 2 * t3, 0};
    // Weights of the slopes at both ends.
    const float start = t3 - 2 * t2 + t, end = t3 - t2;
    const float from = i > 0 ? width * start / (nodes[i + 1] - nodes[i - 1]) : start;
    w[2] += from;
    w[i > 0 ? 0 : 1] -= from;
    const float to = i + 1 < last ? width * end / (nodes[i + 2] - nodes[i]) : end;
    w[1] -= to;
    w[i + 1 < last ? 3 : 2] += to;
    // Without a node before, the four begin one later.
    if (i == 0) return {0, {w[1], w[2], w[3], 0}};
    return {i - 1, w};
}

float integrate_spline(std::span<const float> nodes, std::span<const float> values, std::span<float> cdf) {
    double sum = 0;
    cdf[0] = 0;
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
        sum += static_cast<double>(spline_piece(
                                       nodes, [&](std::size_t j) { return values[j]; }, i)
                                       .integral(1));
        cdf[i + 1] = static_cast<float>(sum);
    }
    return cdf.back();
}

float SplinePiece::at(float t) const {
    const float s0 = slope[0] * width, s1 = slope[1] * width, rise = value[1] - value[0];
    return value[0] + t * (s0 + t * (3 * rise - 2 * s0 - s1 + t * (s0 + s1 - 2 * rise)));
}

float SplinePiece::integral(float t) const {
    const float s0 = slope[0] * width, s1 = slope[1] * width, rise = value[1] - value[0];
    return width * t *
           (value[0] + t * (s0 / 2 + t * ((3 * rise - 2 * s0 - s1) / 3 + t * (s0 + s1 - 2 * rise) / 4)));
}

float SplinePiece::invert_integral(float wanted) const {
    const float whole = integral(1);
    if (!(whole > 0)) return 0;
    return find_root([&](float t) { return integral(t); }, [&](float t) { return width * at(t); },
                     wanted / whole, wanted);
}

float invert_spline(std::span<const float> nodes, std::span<const float> values, float value) {
    if (!(value > values.front())) return nodes.front();
    if (value >= values.back()) return nodes.back();
    const std::size_t i = piece_with(values, value);
    const SplinePiece piece = spline_piece(
        nodes, [&](std::size_t j) { return values[j]; }, i);
    const float t = find_root([&](float x) { return piece.at(x); }, [](float) { return 0.0f; }, 0.5f, value);
    return nodes[i] + t * piece.width;
}

} // namespace alhazen
