#include "textures/noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace alhazen {

namespace {

constexpr std::array<std::uint8_t, 256> permutation = {
#include "textures/data/perlin_permutation.inl"
};
// Not 2, so that the zeros of different octaves do not meet.
constexpr float lacunarity = 1.99f;

std::size_t hash_of_corner(std::size_t x, std::size_t y, std::size_t z) {
    std::size_t h = permutation[x & 255];
    h = permutation[(h + y) & 255];
    return permutation[(h + z) & 255];
}

// The dot product of (x, y, z) with the corner's gradient, which points from a cube's centre to the middle of
// an edge.
float along_gradient(std::size_t hash, Vec3 d) {
    const std::size_t h = hash & 15;
    const float u = h < 8 || h == 12 || h == 13 ? d.x : d.y;
    const float v = h < 4 || h == 12 || h == 13 ? d.y : d.z;
    return (h & 1 ? -u : u) + (h & 2 ? -v : v);
}

// Its first and second derivatives vanish at 0 and 1.
float fade(float t) {
    return t * t * t * (t * (t * 6 - 15) + 10);
}

// A coordinate as a cube's number and the place in it.
struct Place {
    std::size_t cell;
    float offset;

    explicit Place(float x) {
        const float whole = std::floor(x);
        cell = static_cast<std::size_t>(whole - 256 * std::floor(whole / 256));
        offset = x - whole;
    }
};

// How many octaves have waves wider than two widths.
float octaves_seen(int octaves, float width) {
    if (!(width > 0)) return static_cast<float>(octaves);
    return std::clamp(-1 - std::log2(width), 0.0f, static_cast<float>(octaves));
}

// mean: of shape, for the octaves that are not seen.
template <class Shape>
float sum_octaves(Vec3 p, float roughness, int octaves, float width, float mean, const Shape& shape) {
    const float seen = octaves_seen(octaves, width);
    const int whole = static_cast<int>(seen);
    float sum = 0, frequency = 1, strength = 1;
    auto next = [&] {
        frequency *= lacunarity;
        strength *= roughness;
    };
    for (int i = 0; i < whole; ++i, next()) sum += strength * shape(noise(p * frequency));
    const float part = std::clamp((seen - static_cast<float>(whole) - 0.3f) / 0.4f, 0.0f, 1.0f);
    sum += strength * std::lerp(mean, shape(noise(p * frequency)), part * part * (3 - 2 * part));
    // As pbrt-v4, which counts the octave that is seen in part among those that are not seen, too.
    for (int i = whole; i < octaves && mean != 0; ++i, next()) sum += strength * mean;
    return sum;
}

} // namespace

float noise(Vec3 p) {
    const Place x(p.x), y(p.y), z(p.z);
    auto corner = [&](std::size_t i, std::size_t j, std::size_t k) {
        return along_gradient(hash_of_corner(x.cell + i, y.cell + j, z.cell + k),
                              Vec3{x.offset, y.offset, z.offset} -
                                  Vec3{static_cast<float>(i), static_cast<float>(j), static_cast<float>(k)});
    };
    const float wx = fade(x.offset), wy = fade(y.offset), wz = fade(z.offset);
    auto along_x = [&](std::size_t j, std::size_t k) {
        return std::lerp(corner(0, j, k), corner(1, j, k), wx);
    };
    auto on_plane = [&](std::size_t k) { return std::lerp(along_x(0, k), along_x(1, k), wy); };
    return std::lerp(on_plane(0), on_plane(1), wz);
}

float fractal_noise(Vec3 p, float roughness, int octaves, float width) {
    return sum_octaves(p, roughness, octaves, width, 0, [](float n) { return n; });
}

float turbulence(Vec3 p, float roughness, int octaves, float width) {
    constexpr float mean = 0.2f; // of the noise's magnitude
    return sum_octaves(p, roughness, octaves, width, mean, [](float n) { return std::abs(n); });
}

} // namespace alhazen
