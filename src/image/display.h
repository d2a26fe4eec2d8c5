/// Private to the room: linear light as an sRGB display shows it, and planes of floats filtered with
/// separable kernels, which the perceptual metrics are built of.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "color/tone.h"
#include "image/image.h"

namespace alhazen {

/// Throws std::runtime_error unless both have the same size and pixels.
void check_same_size(const Image& a, const Image& b);

/// sRGB-encoded, clamped to 0 ... 1; 0 for what is no number.
inline float display_value(float linear) {
    if (std::isnan(linear)) return 0;
    return srgb_encode(std::clamp(linear, 0.0f, 1.0f));
}

/// One number a pixel.
struct Plane {
    int width = 0, height = 0;
    std::vector<float> values;

    Plane(int w, int h)
        : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), 0.0f) {}
    float& at(int x, int y) { return values[index(x, y)]; }
    float at(int x, int y) const { return values[index(x, y)]; }

  private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

enum class Border {
    clamp,
    /// Half-sample symmetric: pixel -1 is pixel 0.
    mirror
};

/// Correlates with horizontal(x) vertical(y); the kernels' sizes are odd, their middle is 0.
Plane filter_separable(const Plane& in, std::span<const float> horizontal, std::span<const float> vertical,
                       Border border);

} // namespace alhazen
