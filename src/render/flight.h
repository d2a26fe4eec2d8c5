/// The paths that one thread follows at a time: while one waits for its ray, the others go on.
#pragma once

#include <memory>
#include <vector>

#include "integrators/bundle/bundles.h"
#include "integrators/path_context.h"
#include "render/world.h"

namespace alhazen {

/// How many paths to follow at a time in a scene, when nobody says: many, to hide the latency of memory, or
/// one, where the structures fit a core's own cache and there is none to hide; more through distance fields.
int default_paths_in_flight(const Scene& scene);

/// Samples of pixels of which this thread is the only owner.
class Flight {
  public:
    /// The samples first ... end - 1 of each pixel of an area.
    struct Work {
        Rect2i pixels;
        int first_sample = 0, end_sample = 0;
    };

    /// paths: how many are followed at a time; 1: each ray is traced at once; 0: the default, or bundles of
    /// rays where the integrator has them for the scene. centred: rays go through the pixels' centres. The
    /// world must outlive the flight.
    Flight(World& world, int paths, bool centred);
    ~Flight();

    /// Takes the samples and adds them to the film, each pixel's in their order.
    void run(const Work& work);

    PictureCounts counts; ///< so far

  private:
    struct Sample;
    struct Path;
    struct Result;

    SampleStream draw_next(Sample& sample);
    void place_next(Sample& sample);
    void run_bundles();
    bool start_next(Path& path);
    void settle(Path& path);
    void finish(Path& path, Spectrum radiance);
    void add_finished();
    void add(const Result& result, const VisibleSurface* surface);

    World& world_;
    bool centred_;
    Work work_;
    std::uint64_t next_ = 0, count_ = 0; // of the work's samples: the first not begun, and how many there are
    Vec2i next_pixel_;                   // whose the first not begun is
    int next_sample_ = 0;                // and which of that pixel's
    std::uint64_t added_ = 0;            // to the film
    std::unique_ptr<RayBundles> bundles_; // in place of paths, where rays are followed together
    RayQueue queue_;
    std::vector<std::unique_ptr<Path>> paths_;
    std::vector<Result> results_;          // a ring: samples end in another order than they begin
    std::vector<VisibleSurface> surfaces_; // of the results, for films that want them
};

} // namespace alhazen
