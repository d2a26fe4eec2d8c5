/// How many pictures of a loaded scene are made in a second, as a viewer asks for them, and how many with
/// each ray traced alone. Both run in turn in one process; what counts are medians, and the median of the
/// ratios.
#include <algorithm>
#include <cstdio>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "formats/format.h"
#include "lab/timing.h"
#include "render/renderer.h"

namespace alhazen::bench {

namespace {

struct Options {
    std::vector<std::string> scenes{"scenes/whitted-spheres.pbrt"};
    int samples = 1, threads = 2, repeat = 31;
};

RenderSettings settings_of(const Options& options, int in_flight) {
    RenderSettings settings;
    settings.spp = options.samples;
    settings.threads = options.threads;
    settings.paths_in_flight = in_flight;
    return settings;
}

void run(const std::string& scene, const Options& options) {
    Messages messages;
    const RenderSettings usual = settings_of(options, 0), alone = settings_of(options, 1);
    const auto world = build_world(read_scene(scene, messages), usual, messages);
    std::vector<double> frames, ratios;
    for (int i = 0; i < options.repeat; ++i) {
        frames.push_back(render(*world, usual, {}).seconds);
        ratios.push_back(render(*world, alone, {}).seconds / frames.back());
    }
    std::sort(frames.begin(), frames.end());
    const double median = median_of(frames);
    fmt::print(
        "{}: {:.1f} ms a picture, {:.1f} pictures a second (best {:.1f} ms, nine of ten within {:.1f} ms), "
        "{:.1f} times sooner than each ray alone\n",
        scene, median * 1e3, 1 / median, frames.front() * 1e3, frames[frames.size() * 9 / 10] * 1e3,
        median_of(ratios));
}

} // namespace

} // namespace alhazen::bench

int main(int argc, char** argv) {
    using namespace alhazen::bench;
    Options options;
    CLI::App app("counts pictures a second");
    app.add_option("SCENE", options.scenes, "scene files");
    app.add_option("--samples", options.samples, "a pixel");
    app.add_option("--threads", options.threads, "threads");
    app.add_option("--repeat", options.repeat, "pictures of each");
    CLI11_PARSE(app, argc, argv);
    for (const std::string& scene : options.scenes) run(scene, options);
    return 0;
}
