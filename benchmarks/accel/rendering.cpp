#include <filesystem>

#include <fmt/format.h>

#include "benchmarks/accel/suite.h"
#include "formats/format.h"
#include "lab/timing.h"
#include "render/renderer.h"

namespace alhazen::bench {

namespace {

/// A way of handing rays to the structure: what it changes in the settings of a render.
struct Schedule {
    const char* name;
    void (*apply)(RenderSettings&);
};
constexpr Schedule schedules[] = {
    {"single", [](RenderSettings& settings) { settings.paths_in_flight = 1; }},
    {"batched", [](RenderSettings& settings) { settings.paths_in_flight = 128; }},
    {"default", [](RenderSettings&) {}},
};

// Of processor time, since other programs may be running.
double samples_per_second(const std::string& file, const Schedule& schedule, int spp) {
    Messages messages;
    messages.lenient = true;
    RenderSettings settings;
    settings.spp = spp;
    settings.threads = 2;
    settings.integrator = "path";
    schedule.apply(settings);
    auto world = build_world(read_scene(file, messages), settings, messages);
    RenderStats stats;
    const double seconds = processor_seconds_of([&] { stats = render(*world, settings, {}); });
    Rect2i pixels = world->film->pixels();
    return static_cast<double>(pixels.width()) * pixels.height() * stats.samples / seconds;
}

// "kitchen" of "kitchen/scene.pbrt", "materials" of "scenes/materials.pbrt".
std::string name_of_scene(const std::string& file) {
    const std::filesystem::path path(file);
    const std::string stem = path.stem().string();
    return stem == "scene" && path.has_parent_path() ? path.parent_path().filename().string() : stem;
}

} // namespace

Json bench_rendering(const std::string& file, const BenchOptions& options) {
    std::vector<std::vector<double>> rates(std::size(schedules));
    for (int i = 0; i < options.render_repeat; ++i)
        for (std::size_t s = 0; s < std::size(schedules); ++s)
            rates[s].push_back(samples_per_second(file, schedules[s], options.spp));
    Json records = Json::array();
    fmt::print("\n{}: whole pictures, {} samples a pixel, 2 threads; by processor time\n", file, options.spp);
    for (std::size_t s = 0; s < std::size(schedules); ++s) {
        std::vector<double> ratios;
        for (std::size_t i = 0; i < rates[s].size(); ++i) ratios.push_back(rates[s][i] / rates[0][i]);
        records.push_back({{"scene", name_of_scene(file)},
                           {"schedule", schedules[s].name},
                           {"threads", 2},
                           {"samples_per_s", median_of(rates[s])},
                           {"spread", spread_of(rates[s])},
                           {"ratio", median_of(ratios)}});
        fmt::print("  {:<10}{:>12.0f} samples/s  x{:.2f}\n", schedules[s].name, median_of(rates[s]),
                   median_of(ratios));
    }
    return records;
}

} // namespace alhazen::bench
