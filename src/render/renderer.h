/// Rendering: passes of tiles, each adding samples to its own pixels, until all are there or someone says
/// stop.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include "image/image.h"
#include "render/flight.h"
#include "render/world.h"

namespace alhazen {

struct Progress {
    int samples_done = 0; ///< per pixel, passes that are finished
    int samples_total = 0;
    double fraction = 0; ///< of all the work, unfinished tiles counted in
    double seconds = 0;  ///< since rendering began
    double seconds_left = 0;
    double rays_per_second = 0; ///< 0 until the first pass is finished
};

struct RenderStats {
    double seconds = 0;
    int samples = 0; ///< per pixel
    RayCounts rays;
    std::uint64_t bad_samples = 0;
    std::vector<BadSample> first_bad_samples; ///< up to ten, in pixel order
    bool cancelled = false;
    std::optional<Quadrature> quadrature; ///< of integrators that integrate something known
};

/// How rendering talks to the one who asked for it.
struct RenderWatch {
    /// Called now and then, from one thread at a time.
    std::function<void(const Progress&)> progress;
    /// Set from anywhere: the pass in hand is finished and rendering ends.
    const std::atomic<bool>* cancel = nullptr;
};

/// Renders into world.film on settings.threads threads. The image depends on the scene and the seed only: not
/// on threads, tile size, passes or what else the machine does. Throws std::runtime_error if texels that lie
/// in a temporary file could not be read.
RenderStats render(World& world, const RenderSettings& settings, const RenderWatch& watch);

} // namespace alhazen
