/// The scenes that another renderer made reference images of, and what it took it.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

namespace alhazen::bench {

/// One picture by the other renderer.
struct PeerRun {
    int spp = 0;
    double cpu_seconds = 0; ///< loading included
    double relmse = 0;      ///< against the reference, the largest 0.1 % left out
};

/// A scene in a folder of its own with scene.pbrt, reference.exr and reference.json.
struct SceneFacts {
    std::string name;
    PeerRun few, many;
    /// How far the means differ by design, at most; docs/validation.md says why. 0: they do not.
    double known_difference = 0;
};

/// Of the mean square of z: a known difference shows elsewhere in the picture in proportion to that of its
/// means.
inline constexpr double largest_known_z2 = 10;

/// "agrees", "differs by design" where that explains it, else "DIFFERS"; agrees, the ratios of the means and
/// the mean square of z are those of the ReferenceComparison.
std::string_view verdict_on(const SceneFacts& facts, bool agrees, const std::array<double, 3>& mean_ratio,
                            double mean_z2);
inline constexpr std::string_view differs = "DIFFERS";

/// In the order of the page. The figures are pbrt-v4's, as the scenes' README has them.
std::span<const SceneFacts> validation_scenes();

} // namespace alhazen::bench
