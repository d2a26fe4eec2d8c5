/// Camera rays that are followed together, lane by lane.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "color/spectrum.h"
#include "integrators/path_context.h"

namespace alhazen {

struct RayBundles {
    virtual ~RayBundles() = default;
    /// The radiance arriving against each ray, in RGB. May be called from any thread.
    virtual void radiance(std::span<const Ray> rays, std::span<Spectrum> radiance,
                          RayCounts& counts) const = 0;
};

/// So many surfaces deep the Whitted integrator follows all rays; behind them only those whose light counts
/// for more than whitted_least_weight, which bundles do not know.
constexpr int whitted_whole_depth = 8;
constexpr float whitted_least_weight = 1.0f / 1024;

/// What the recursion of the Whitted integrator is given.
struct WhittedSettings {
    int maxdepth = 5;
    bool shadows = true;
    Spectrum ambient = 0;
};

/// For scenes as the method's first ones: nothing but a few whole balls that stand still, opaque, with
/// Phong's surfaces of one colour, lights that shine alike from a point, and no structure that somebody
/// chose; and no deeper than whitted_whole_depth. nullptr for others.
std::unique_ptr<RayBundles> whitted_bundles(const Scene& scene, const WhittedSettings& settings);
/// The same by a kernel of a name in bundle_kernel_names().
std::unique_ptr<RayBundles> whitted_bundles(const Scene& scene, const WhittedSettings& settings,
                                            std::string_view kernel);
/// Of the kernels that this processor can run, the best first.
std::vector<std::string_view> bundle_kernel_names();

} // namespace alhazen
