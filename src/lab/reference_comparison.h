/// One scene against its reference image: renders with several seeds, and what their agreement says.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "describe/scene_description.h"
#include "image/image.h"

namespace alhazen {

struct ReferenceComparisonOptions {
    int seeds = 8;
    int spp = 0;            ///< of each seed; 0: as many as the time allows
    double seconds = 240;   ///< for the whole scene, about
    std::string integrator; ///< instead of the scene's
    std::string scene_file = "scene.pbrt";
    std::function<void(SceneDescription&)> change; ///< made to the scene before it is built; may be empty
};

/// Errors of pictures with more and more samples.
struct ErrorAt {
    int spp = 0;
    double relmse = 0; ///< the largest 0.1 % left out
};

struct ReferenceComparison {
    std::string scene;
    Image ours, reference;
    int spp = 0, seeds = 0;                   ///< samples a pixel of each seed
    double cpu_seconds = 0;                   ///< of one seed's picture, loading included
    double load_seconds = 0;                  ///< of it, before the first ray
    std::array<double, 3> mean_ratio{};       ///< of ours over the reference's, red, green, blue
    std::array<double, 3> mean_ratio_error{}; ///< standard error, of both images' noise
    std::vector<ErrorAt> errors;              ///< of one seed, two seeds' mean ... all
    double noise = 0; ///< relMSE of one seed's picture against its expectation, from the seeds alone
    double reference_noise = 0; ///< the same of the reference, as its makers state it
    /// What both noises leave unexplained of the error of all seeds' mean: about 0, unless a picture is
    /// wrong.
    double unexplained = 0;
    double mean_z2 = 0;     ///< mean square of z over blocks of pixels: about 1 to 1.5
    double beyond_four = 0; ///< fraction of the blocks with |z| above 4
    int block = 0;          ///< side of a block in pixels
    double flip = 0;
};

/// Sets a parameter of the path tracer, where the scene is rendered by it; other integrators have no such
/// parameter.
void set_path_parameter(SceneDescription& scene, const Parameter& parameter);

/// folder: with scene.pbrt, reference.exr, reference.json. Throws std::runtime_error or SceneError.
ReferenceComparison compare_with_reference(const std::filesystem::path& folder,
                                           const ReferenceComparisonOptions& options);

/// Whether the means agree to half a percent, or to what noise allows (3.5 standard errors), and blocks do
/// too.
bool agrees(const ReferenceComparison& c);

/// Ours, the reference, and FLIP's error as a heat map, side by side.
Image side_by_side(const ReferenceComparison& c);

} // namespace alhazen
