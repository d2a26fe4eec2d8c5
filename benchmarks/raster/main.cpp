/// How long the rasteriser takes for a picture, beside ray casting of the same: scenes made by formula and
/// scene files. Both run in turn in one process; what counts is the median, and for the comparison the median
/// of the ratios.
#include <cstdio>
#include <ctime>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/stopwatch.h"
#include "base/threads.h"
#include "benchmarks/accel/meshes.h"
#include "formats/format.h"
#include "lab/timing.h"
#include "raster/rasterizer.h"
#include "render/renderer.h"

namespace alhazen::bench {

namespace {

struct Options {
    std::vector<std::string> scenes{"gallery"};
    std::vector<int> samples{1, 4};
    Vec2i size{1280, 720};
    int threads = 2, repeat = 15;
    bool shadows = false, alone = false;
};

SceneDescription describe(const std::string& scene, Messages& messages) {
    for (const GeneratedScene& generated : generated_scenes())
        if (generated.name == scene) return generated.make();
    return read_scene(scene, messages);
}

std::unique_ptr<World> make_world(const std::string& scene, const Options& options, int samples,
                                  bool by_rays) {
    Messages messages;
    messages.lenient = true;
    RenderSettings settings;
    settings.size = options.size;
    settings.spp = samples;
    settings.threads = options.threads;
    settings.integrator = "raster";
    if (options.shadows) settings.overrides.push_back("integrator.shadows=true");
    // A camera with a lens has no projection; one so small blurs nothing.
    if (by_rays) settings.overrides.push_back("camera.lensradius=1e-9");
    return build_world(describe(scene, messages), settings, messages);
}

/// Processor time of all threads so far: what a busy machine does not add to.
double processor_milliseconds() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC * 1e3;
}

double milliseconds(World& world, const Options& options) {
    RenderSettings settings;
    settings.threads = options.threads;
    return render(world, settings, {}).seconds * 1e3;
}

/// Only what is seen, without shading or film.
double visibility_milliseconds(const World& world, const Options& options) {
    double result = 0;
    with_threads(options.threads, [&] {
        const Stopwatch watch;
        Rasterizer(*world.scene, *world.camera, world.spp).run(world.film->pixels(), [](const DrawnTile&) {});
        result = watch.seconds() * 1e3;
    });
    return result;
}

void run(const std::string& scene, int samples, const Options& options) {
    auto raster = make_world(scene, options, samples, false);
    auto rays = options.alone ? nullptr : make_world(scene, options, samples, true);
    std::vector<double> visible, whole, cast, ratio, busy, busy_visible;
    for (int i = 0; i < options.repeat; ++i) {
        const double start = processor_milliseconds();
        visible.push_back(visibility_milliseconds(*raster, options));
        const double before = processor_milliseconds();
        busy_visible.push_back((before - start) / options.threads);
        whole.push_back(milliseconds(*raster, options));
        busy.push_back((processor_milliseconds() - before) / options.threads);
        if (!rays) continue;
        cast.push_back(milliseconds(*rays, options));
        ratio.push_back(cast.back() / whole.back());
    }
    std::sort(whole.begin(), whole.end());
    fmt::print("{:<40} {:>8} triangles {:>3} samples: visibility {:6.1f} ms (processor {:.1f} a thread), "
               "picture {:6.1f} ms (best {:.1f}, processor {:.1f} a thread)",
               scene, raster->scene->counts().triangles, samples, median_of(visible), median_of(busy_visible),
               median_of(whole), whole.front(), median_of(busy));
    if (rays) fmt::print(", by rays {:7.1f} ms, x{:.1f}", median_of(cast), median_of(ratio));
    fmt::print("\n");
    std::fflush(stdout);
}

} // namespace

} // namespace alhazen::bench

int main(int argc, char** argv) {
    using namespace alhazen::bench;
    Options options;
    CLI::App app("times the rasteriser");
    app.add_option("SCENE", options.scenes, "names of generated scenes (see bench_accel), or scene files");
    app.add_option("--samples", options.samples, "a pixel: 1, 4, 8, 16")->delimiter(',');
    app.add_option("--width", options.size.x, "pixels");
    app.add_option("--height", options.size.y, "pixels");
    app.add_option("--threads", options.threads, "threads");
    app.add_option("--repeat", options.repeat, "runs of each");
    app.add_flag("--shadows", options.shadows, "with shadow maps");
    app.add_flag("--alone", options.alone, "no pictures by rays");
    CLI11_PARSE(app, argc, argv);
    for (const std::string& scene : options.scenes)
        for (int samples : options.samples) run(scene, samples, options);
    return 0;
}
