/// Compares what the rasteriser shows with what rays meet.
#pragma once

#include <mutex>

#include "raster/rasterizer.h"
#include "render/world.h"

namespace alhazen::testing {

struct Agreement {
    std::size_t pixels = 0, hits = 0, same = 0;
    double share() const { return static_cast<double>(same) / static_cast<double>(pixels); }
};

// The nearest hit that is not a border of media.
inline std::optional<Hit> first_surface(const World& world, Vec2 film) {
    CameraSample at;
    at.film = film;
    Ray ray = world.camera->ray(at)->ray;
    for (;;) {
        auto hit = world.scene->closest(ray);
        if (!hit || !hit->material->is_interface()) return hit;
        ray = hit->spawn(ray.d);
    }
}

inline bool shows(const DrawnTile& tile, std::uint32_t number, const std::optional<Hit>& hit) {
    if (number == DrawnTile::nothing || !hit) return number == DrawnTile::nothing && !hit;
    const auto [surface, primitive] = tile.fragment(number);
    return hit->shape == surface->shape && hit->primitive == primitive &&
           hit->instance == surface->instance_number();
}

/// A pixel agrees when the ray through its middle meets first what is shown; where the middle is on a border,
/// to within the 4096th of a pixel to which corners are rounded, what either side's ray meets.
inline Agreement compare_first_hits(const World& world) {
    Agreement result;
    std::mutex mutex;
    constexpr float r = 1.0f / 2048;
    Rasterizer(*world.scene, *world.camera, 1).run(world.film->pixels(), [&](const DrawnTile& tile) {
        Agreement part;
        for (int y = tile.pixels().lo.y; y < tile.pixels().hi.y; ++y)
            for (int x = tile.pixels().lo.x; x < tile.pixels().hi.x; ++x) {
                const Vec2 middle{static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f};
                const std::uint32_t number = tile.number({x, y}, 0);
                const auto hit = first_surface(world, middle);
                bool same = shows(tile, number, hit);
                for (Vec2 d : {Vec2{r, 0}, Vec2{-r, 0}, Vec2{0, r}, Vec2{0, -r}})
                    same = same || shows(tile, number, first_surface(world, middle + d));
                ++part.pixels;
                part.hits += hit.has_value();
                part.same += same;
            }
        std::scoped_lock lock(mutex);
        result.pixels += part.pixels;
        result.hits += part.hits;
        result.same += part.same;
    });
    return result;
}

} // namespace alhazen::testing
