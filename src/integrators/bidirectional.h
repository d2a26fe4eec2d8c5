/// Bidirectional paths (Lafortune and Willems 1993; Veach 1997, chapter 10): a walk from a light and one from
/// the camera, each vertex of one joined with each vertex of the other. A path can be found in as many ways
/// as it has vertices; each way is weighed by how likely it was to find the path (see Alternatives), so that
/// each kind of light comes by the way that finds it best. Media are crossed as by the path tracer through
/// them, and a place where one scatters is a vertex like any other (Lafortune and Willems 1996); what they
/// let through is left out of the weights, which so are alike for all ways. Picture two people who walk
/// towards each other through a house: however hidden the lamp, somewhere they stand in one line of sight.
#pragma once

#include <optional>

#include "integrators/alternatives.h"
#include "integrators/light_start.h"
#include "integrators/path_context.h"
#include "integrators/picture.h"
#include "materials/bsdf.h"

namespace alhazen {

/// A way of finding a path: how many of its vertices come from a light and from the camera, the point on the
/// light and the one on the lens counted in.
struct Strategy {
    int light = 0, camera = 0;

    int bounces() const { return light + camera - 2; }
    bool operator==(const Strategy&) const = default;
};

/// A path that was found.
struct FoundPath {
    Strategy strategy;
    Spectrum L;                  ///< what it brings if nothing else could find it
    double weight = 1;           ///< the strategy's among all that could
    bool one_wavelength = false; ///< it brings the first wavelength only
    std::optional<Vec2> film;    ///< where it arrives, when its last surface was joined with the lens

    /// What counts in the wavelengths that were drawn.
    Spectrum value() const {
        const Spectrum all = L * static_cast<float>(weight);
        return one_wavelength ? Spectrum(4 * all[0], 0, 0, 0) : all;
    }
};

/// Who takes the paths.
struct PathTaker {
    virtual void take(const FoundPath& found) = 0;

  protected:
    ~PathTaker() = default;
};

class Bidirectional {
  public:
    struct Options {
        int maxdepth = 5;
        bool regularize = false;
        bool roulette = true; ///< paths that carry little end by chance
    };
    Bidirectional(const PictureOrder& picture, const Options& options);

    /// All paths that a camera ray and one path from a light make together, or those of one strategy only.
    /// Numbers are at the same places of path.samples whatever happens on the way.
    Task<bool> find_paths(Ray camera_ray, PathContext& path, PathTaker& taker,
                          std::optional<Strategy> only = std::nullopt) const;

  private:
    struct Vertex;
    struct Walk;
    struct Wanted;
    struct Join;

    Task<const Vertex*> walk_from_light(const Walk& camera, PathContext& path, PathTaker& taker,
                                        Wanted wanted) const;
    Task<bool> walk_from_camera(Walk walk, std::optional<Hit> hit, PathContext& path, const Vertex* lit,
                                PathTaker& taker, Wanted wanted) const;

    Task<bool> cross_media(Join& join, const Vertex& from, const Vertex* to, PathContext& path) const;

    Vec2 next_on_lens(SampleStream& samples) const;
    Alternatives first_from_light(const LightStart& start, const Hit& hit) const;
    Alternatives first_from_camera(const Walk& walk, const Hit& hit) const;
    Alternatives arrive(const Walk& walk, const Hit& hit) const;
    bool scatter(Walk& walk, const Vertex& vertex, SampleStream& samples, TransportMode mode) const;

    void take_emitted(const Walk& walk, const Hit& hit, const Alternatives& others, int number,
                      PathTaker& taker) const;
    void take_glow(const Walk& walk, Spectrum emitted, int number, PathTaker& taker) const;
    void take_escaped(const Walk& walk, int number, const PathContext& path, PathTaker& taker) const;
    double emission_weight(const Walk& walk, const Light& light, double direct, LeavingPdf leaving,
                           const Alternatives& others) const;
    std::optional<Join> join_light(const Vertex& vertex, PathContext& path) const;
    std::optional<Join> join_camera(const Vertex& vertex, Vec2 lens) const;
    std::optional<Join> join(const Vertex& seen, const Vertex& lit) const;

    const Scene& scene_;
    const Camera& camera_;
    const Film& film_;
    Options options_;
    bool has_media_; ///< where not, nobody asks for any
    std::unique_ptr<LightChooser> lights_;
    double
        light_paths_; ///< paths from lights for each sample of a pixel, all pixels of the film having samples
};

} // namespace alhazen
