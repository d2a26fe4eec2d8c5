/// alhazen render: a scene file becomes pictures.
#include <cstdio>

#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "base/stopwatch.h"
#include "base/threads.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/progress.h"
#include "cli/show.h"
#include "formats/format.h"
#include "image/codec.h"
#include "lab/json_text.h"
#include "render/renderer.h"

namespace alhazen {

namespace {

struct RenderOptions {
    std::string scene;
    std::vector<std::string> outputs;
    SceneOptions scene_options;
    std::string stats_file;
    bool quiet = false;
    bool show = false;
};

struct Timing {
    double load = 0, build = 0;
};

// "teapot.v2" of "scenes/teapot.v2.pbrt.gz".
std::string scene_stem(const std::string& scene) {
    std::filesystem::path name = std::filesystem::path(scene).filename();
    if (name.extension() == ".gz") name = name.stem();
    return name.stem().string();
}

// As one word of a shell's command line.
std::string quoted_for_shell(std::string_view text) {
    constexpr std::string_view plain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=,:+@%";
    if (!text.empty() && text.find_first_not_of(plain) == std::string_view::npos) return std::string(text);
    std::string quoted = "'";
    for (char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

std::int64_t peak_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return std::int64_t{usage.ru_maxrss} * 1024;
}

WriteOptions write_options(const World& world) {
    WriteOptions options;
    options.depth = world.film->half_float() ? FloatDepth::half : FloatDepth::single;
    options.transfer = world.film->linear_transfer() ? Transfer::linear : Transfer::srgb;
    options.metadata["Software"] = "Alhazen " ALHAZEN_VERSION;
    return options;
}

// The integrator's further pictures, under its names beside the first output; how many there are.
std::size_t write_layers(const World& world, const std::string& first_output) {
    const auto names = world.integrator->splat_layers();
    const auto folder = std::filesystem::path(first_output).parent_path();
    for (std::size_t i = 0; i < names.size(); ++i)
        write_image(folder / (names[i] + ".exr"), world.film->splat_image(i + 1), write_options(world));
    return names.size();
}

void write_outputs(const World& world, const Image& image, const std::vector<std::string>& outputs) {
    const WriteOptions options = write_options(world);
    for (const std::string& file : outputs) {
        try {
            write_image(file, image, options);
        } catch (const std::exception& e) {
            throw std::runtime_error(fmt::format("cannot write \"{}\": {}", file, e.what()));
        }
    }
}

// How near an integration came, where one was made: its files, and the table on the terminal.
void tell_quadrature(const Quadrature& q, const World& world, bool quiet) {
    std::string lines;
    for (const QuadratureError& e : q.errors)
        lines += fmt::format("{} {:g}\n", e.samples, e.mean_squared_error);
    if (!q.errors_file.empty()) write_file(q.errors_file, lines);
    if (!q.integrand_file.empty()) write_image(q.integrand_file, q.integrand, write_options(world));
    if (quiet) return;
    fmt::print("{:>8}  mean squared error\n", "samples");
    for (const QuadratureError& e : q.errors) fmt::print("{:>8}  {:.3e}\n", e.samples, e.mean_squared_error);
}

nlohmann::ordered_json texture_json(const TextureMemory& memory) {
    nlohmann::ordered_json json;
    json["peak_bytes"] = memory.peak_bytes;
    if (memory.limit_bytes == 0) return json;
    json["limit_bytes"] = memory.limit_bytes;
    json["tiles_made"] = memory.tiles_made;
    json["tiles_dropped"] = memory.tiles_dropped;
    json["temporary_file_bytes"] = memory.file_bytes;
    return json;
}

void write_stats(const RenderOptions& options, const World& world, const RenderStats& stats,
                 const Timing& timing, const Messages& messages) {
    SceneCounts counts = world.scene->counts();
    nlohmann::ordered_json json;
    json["scene"] = options.scene;
    json["load_seconds"] = timing.load;
    json["build_seconds"] = timing.build;
    json["render_seconds"] = stats.seconds;
    json["samples_per_pixel"] = stats.samples;
    json["width"] = world.film->pixels().width();
    json["height"] = world.film->pixels().height();
    json["rays"] = {{"camera", stats.rays.camera},
                    {"bounce", stats.rays.bounce},
                    {"shadow", stats.rays.shadow},
                    {"total", stats.rays.total()}};
    json["mrays_per_second"] = static_cast<double>(stats.rays.total()) / 1e6 / std::max(stats.seconds, 1e-9);
    json["peak_memory_bytes"] = peak_memory_bytes();
    json["textures"] = texture_json(world.textures.memory());
    json["triangles"] = counts.triangles;
    json["primitives"] = counts.primitives;
    json["instances"] = counts.instances;
    json["threads"] = options.scene_options.settings.threads > 0 ? options.scene_options.settings.threads
                                                                 : hardware_threads();
    json["non_finite_samples"] = stats.bad_samples;
    json["cancelled"] = stats.cancelled;
    if (stats.quadrature) {
        json["quadrature_errors"] = nlohmann::json::array();
        for (const QuadratureError& e : stats.quadrature->errors)
            json["quadrature_errors"].push_back(
                {{"samples", e.samples}, {"mean_squared_error", e.mean_squared_error}});
    }
    json["warnings"] = nlohmann::json::array();
    for (const Message& m : messages.warnings()) json["warnings"].push_back(m.full_text());
    write_file(options.stats_file, json_text(json));
}

// The command line's options that decide what a sample is, to see one again.
std::string repeated_options(const RenderSettings& s, int samples) {
    std::string text = fmt::format(" --spp {}", samples);
    auto add = [&](std::string_view option, std::string_view value) {
        text += fmt::format(" {} {}", option, quoted_for_shell(value));
    };
    if (!s.integrator.empty()) add("--integrator", s.integrator);
    if (!s.camera.empty()) add("--camera", s.camera);
    if (s.size) add("--size", fmt::format("{}x{}", s.size->x, s.size->y));
    if (s.seed) add("--seed", std::to_string(*s.seed));
    if (s.color) add("--color", *s.color == ColorMode::rgb ? "rgb" : "spectral");
    for (const std::string& setting : s.overrides) add("--set", setting);
    return text;
}

void report_bad_samples(const RenderOptions& options, const World& world, const RenderStats& stats) {
    if (stats.bad_samples == 0) return;
    fmt::print(stderr, "alhazen: warning: {} samples were not finite numbers and were left out; the first:\n",
               stats.bad_samples);
    for (const BadSample& bad : stats.first_bad_samples) {
        // What lands on other pixels is seen in the whole picture only.
        const std::string crop = world.integrator->makes_splats()
                                     ? ""
                                     : fmt::format(" --crop {},{},{},{}", bad.pixel.x, bad.pixel.y,
                                                   bad.pixel.x + 1, bad.pixel.y + 1);
        fmt::print(stderr, "    pixel {},{} sample {}: alhazen render {}{}{}\n", bad.pixel.x, bad.pixel.y,
                   bad.sample, quoted_for_shell(options.scene), crop,
                   repeated_options(options.scene_options.settings, stats.samples));
    }
}

RenderStats render_with_progress(World& world, const RenderOptions& options) {
    const InterruptWatch interrupt;
    ProgressBar bar(options.quiet);
    RenderWatch watch;
    watch.cancel = &interrupt.interrupted();
    watch.progress = [&](const Progress& p) { bar.update(p); };
    RenderStats stats = render(world, options.scene_options.settings, watch);
    bar.finish();
    return stats;
}

// A picture for the viewer: one of the outputs that it can show, else a PNG of its own.
std::filesystem::path picture_for_viewer(const World& world, const Image& image,
                                         const std::vector<std::string>& outputs) {
    for (const std::string& file : outputs)
        if (!is_float_suffix(std::filesystem::path(file).extension().string())) return file;
    auto file = std::filesystem::temp_directory_path() / fmt::format("alhazen-{}.png", getpid());
    write_outputs(world, image, {file.string()});
    return file;
}

std::vector<std::string> files_of(const RenderOptions& options) {
    std::vector<std::string> files = options.outputs;
    files.push_back(options.stats_file);
    return files;
}

int run_render(RenderOptions& options) {
    for (const std::string& file : options.outputs) check_picture_output(file);
    check_outputs(options.scene, files_of(options));

    Messages messages;
    messages.lenient = options.scene_options.lenient;
    Timing timing;
    const Stopwatch watch;
    std::unique_ptr<World> world;
    with_threads(options.scene_options.settings.threads, [&] {
        SceneDescription description = read_scene(options.scene, messages);
        timing.load = watch.seconds();
        world = build_world(std::move(description), options.scene_options.settings, messages);
        timing.build = watch.seconds() - timing.load;
    });
    for (const Message& m : messages.warnings())
        if (!options.quiet) fmt::print(stderr, "{}\n", m.full_text());
    if (options.outputs.empty()) {
        std::string own = world->film->filename();
        options.outputs = {own.empty() ? scene_stem(options.scene) + ".exr" : own};
        check_picture_output(options.outputs.front());
        check_outputs(options.scene, files_of(options));
    }

    RenderStats stats = render_with_progress(*world, options);
    Image image = world->film->image();
    write_outputs(*world, image, options.outputs);
    const std::size_t layers = write_layers(*world, options.outputs.front());
    report_bad_samples(options, *world, stats);
    if (stats.quadrature) tell_quadrature(*stats.quadrature, *world, options.quiet);
    if (!options.stats_file.empty()) write_stats(options, *world, stats, timing, messages);
    if (stats.cancelled && !options.quiet)
        fmt::print(stderr, "stopped after {} of {} samples per pixel; the picture so far is written\n",
                   stats.samples, world->spp);
    if (!options.quiet)
        for (const std::string& file : options.outputs)
            fmt::print("{}: {} x {}, {} spp, {}, {:.2f} Mrays/s\n", file, image.width(), image.height(),
                       stats.samples, duration_text(stats.seconds),
                       static_cast<double>(stats.rays.total()) / 1e6 / std::max(stats.seconds, 1e-9));
    if (layers > 0 && !options.quiet)
        fmt::print("and {} pictures of the integrator's, as OpenEXR beside it\n", layers);
    if (options.show) show_picture(image, picture_for_viewer(*world, image, options.outputs));
    return stats.cancelled ? exit_interrupted : exit_ok;
}

} // namespace

void add_render_command(CLI::App& app, Action& action) {
    auto options = std::make_shared<RenderOptions>();
    CLI::App* command = app.add_subcommand("render", "render a scene into image files");
    command->add_option("SCENE", options->scene, "scene file (.pbrt)")->required();
    command
        ->add_option("-o,--output", options->outputs,
                     "image file; give several for several formats (.exr .png .jpg .hdr .pfm ...)")
        ->type_name("FILE")
        ->expected(1)
        ->take_all();
    add_scene_options(*command, options->scene_options);
    command->add_flag("-q,--quiet", options->quiet, "print nothing but errors");
    command->add_option("--stats", options->stats_file, "write timings and counts as JSON")
        ->type_name("FILE");
    command->add_flag("--show", options->show, "put the picture on the screen when done");
    command->callback([options, &action] { action = [options] { return run_render(*options); }; });
}

} // namespace alhazen
