/// Curves through given points, by cubics whose slope at a point is that of the line through its neighbours
/// (Catmull and Rom 1974; for uneven nodes as in Pharr et al. 2016, section 8.6.1). Smooth functions need few
/// nodes. A curve may overshoot its points a little, and so be slightly negative where they are not.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace alhazen {

/// The value at a place as a sum of up to four neighbouring nodes' values.
struct SplineWeights {
    std::size_t first = 0; ///< node that weight[0] belongs to
    std::array<float, 4> weight{};

    /// Of the values at the nodes, each `stride` behind the one before.
    float sum(const float* values, std::size_t stride = 1) const {
        float s = 0;
        // A weight of 0 may stand for a node that is not there.
        for (std::size_t i = 0; i < 4; ++i)
            if (weight[i] != 0) s += weight[i] * values[(first + i) * stride];
        return s;
    }
};
/// nodes increase, and are at least 4; x is clamped to them.
SplineWeights spline_weights(std::span<const float> nodes, float x);

/// Integral of the curve from the first node to each, into cdf. Gives that to the last.
float integrate_spline(std::span<const float> nodes, std::span<const float> values, std::span<float> cdf);

/// One piece of a curve: its length, its values at both ends, and its slopes there.
struct SplinePiece {
    float width = 0;
    std::array<float, 2> value{}, slope{};

    /// At the fraction t of its width.
    float at(float t) const;
    /// From its start to t.
    float integral(float t) const;
    /// The t up to which it has that integral, if the piece is not negative; clamped to 0 ... 1.
    float invert_integral(float integral) const;
};
/// The piece from node i to the next, of values that value(j) gives.
template <class Value>
SplinePiece spline_piece(std::span<const float> nodes, Value value, std::size_t i) {
    const std::size_t before = i == 0 ? 0 : i - 1, after = i + 2 == nodes.size() ? i + 1 : i + 2;
    const float v0 = value(i), v1 = value(i + 1);
    const float left = before == i ? v0 : value(before), right = after == i + 1 ? v1 : value(after);
    return {nodes[i + 1] - nodes[i],
            {v0, v1},
            {(v1 - left) / (nodes[i + 1] - nodes[before]), (right - v0) / (nodes[after] - nodes[i])}};
}

/// Where a curve that increases from node to node has a value; clamped to the nodes.
float invert_spline(std::span<const float> nodes, std::span<const float> values, float value);

} // namespace alhazen
