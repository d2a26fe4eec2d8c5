/// What the user asks for beside the scene file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "accel/accel.h"
#include "base/bounds.h"
#include "color/wavelengths.h"

namespace alhazen {

/// Unset members leave the scene's own values.
struct RenderSettings {
    std::optional<int> spp;     ///< samples per pixel
    std::optional<Vec2i> size;  ///< film resolution, pixels
    std::optional<Rect2i> crop; ///< pixels to render, of the full film
    std::string integrator;     ///< replaces the scene's, which keeps the parameters both know
    std::string camera;         ///< by name
    std::optional<std::uint64_t> seed;
    std::optional<AccelChoice> accel; ///< does not change the image, except for "sdf"
    std::optional<int> stack_entries; ///< of the walk with a short stack (1 ... 64)
    int threads = 0;                  ///< 0: all
    /// Bytes of texels of images in memory, the others in a temporary file. Does not change the image.
    std::optional<std::size_t> texture_memory;
    std::optional<ColorMode> color; ///< default: spectral, but rgb for integrators that are defined in it
    int tile_size = 32;             ///< pixels; does not change the image
    /// Paths that a thread follows at a time, so that their rays are traced together; 1: each ray alone; 0:
    /// many where the scene does not fit the processor's caches, or bundles of rays where the integrator has
    /// them for the scene. Does not change the image.
    int paths_in_flight = 0;
    /// "integrator.maxdepth=3", "material.Floor.reflectance=.5 .4 .3"
    std::vector<std::string> overrides;
};

} // namespace alhazen
