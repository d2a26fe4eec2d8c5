/// Blue noise: a square of numbers, repeating, in which near numbers differ as much as they can. Dithering by
/// it pushes the errors of neighbouring pixels apart, where the eye averages them (Georgiev and Fajardo 2016,
/// "Blue-noise Dithered Sampling").
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace alhazen {

class BlueNoise {
  public:
    static constexpr int side = 128;

    /// Computed at the first call, shared by all.
    static const BlueNoise& get();

    /// A number in (0, 1) for a pixel; each dimension and key sees the square from another corner, and turned
    /// over, so that they are not tied to each other.
    float at(Vec2i pixel, std::uint32_t dimension, std::uint32_t key) const;
    /// From 0 to side^2 - 1, each once.
    int rank(int x, int y) const { return ranks_[static_cast<std::size_t>(y * side + x)]; }

  private:
    BlueNoise();
    std::vector<std::uint16_t> ranks_;
};

} // namespace alhazen
