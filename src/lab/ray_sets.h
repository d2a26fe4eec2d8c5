/// The rays that structures are measured with: those a path tracer would ask for in the scene, kind by kind.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "render/world.h"

namespace alhazen {

enum class RayKind {
    primary, ///< from the camera through the pixels' centres, in tiles of 8 x 8 pixels: neighbours go alike
    diffuse, ///< from surfaces into the half space above, by the cosine; up to three bounces; shuffled
    ao,      ///< the same, but short: ambient occlusion
    shadow,  ///< from surfaces towards points on the lights (without lights: points in the scene's box)
};
std::string_view name_of(RayKind kind);

struct RaySet {
    RayKind kind = RayKind::primary;
    std::vector<Ray> rays;
};

struct RaySetOptions {
    std::size_t rays = 100000; ///< of each kind, about; at least 64
    std::uint64_t seed = 1;
};

/// One set of each kind, in that order; those that start at surfaces are empty when the camera sees nothing,
/// and may fall short when it sees little. They depend on scene, camera and seed only.
std::vector<RaySet> make_ray_sets(const World& world, const RaySetOptions& options = {});

/// Pixels of a picture with the film's shape and about so many pixels, each side a multiple of 8.
Vec2i tiled_size(Vec2i film, std::size_t pixels);
/// The camera's ray through the centre of a pixel of a picture of that size; nullopt where it sees nothing.
std::optional<Ray> camera_ray(const World& world, Vec2i pixel, Vec2i size);

} // namespace alhazen
