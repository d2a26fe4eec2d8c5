/// alhazen accel: acceleration structures measured on a scene.
#include <cstdio>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/file.h"
#include "base/threads.h"
#include "cli/commands.h"
#include "cli/outputs.h"
#include "cli/terminal.h"
#include "formats/format.h"
#include "lab/report.h"
#include "lab/timing.h"

namespace alhazen {

namespace {

struct AccelOptions {
    std::string scene, json_file, html_file;
    std::vector<std::string> builders, walks;
    RenderSettings settings;
    LabOptions lab;
    bool lenient = false, quiet = false;
};

/// Pixels of the heat maps in the page.
constexpr std::size_t heat_map_pixels = 240 * 180;

// "a,b" and "c" are a, b and c; none at all are all there are.
template <class Entry>
std::vector<std::string> split_names(const std::vector<std::string>& texts, std::span<const Entry> all) {
    std::vector<std::string> names;
    for (const std::string& text : texts) {
        std::size_t from = 0;
        for (std::size_t comma = 0; comma != std::string::npos; from = comma + 1) {
            comma = text.find(',', from);
            names.push_back(text.substr(from, comma == std::string::npos ? comma : comma - from));
        }
    }
    if (texts.empty())
        for (const Entry& entry : all) names.emplace_back(entry.name);
    return names;
}

std::vector<AccelChoice> choices_of(const AccelOptions& options) {
    std::vector<AccelChoice> choices;
    for (const std::string& builder : split_names(options.builders, accel_builders()))
        for (const std::string& walk : split_names(options.walks, accel_walks())) {
            std::string error;
            if (builder.empty() || walk.empty())
                throw std::runtime_error(builder.empty() ? "--builder: a name is missing"
                                                         : "--walk: a name is missing");
            auto choice = parse_accel(fmt::format("{}/{}", builder, walk), error);
            if (!choice) throw std::runtime_error(error);
            if (options.settings.stack_entries)
                choice->walk_options.stack_entries = *options.settings.stack_entries;
            choices.push_back(*choice);
        }
    return choices;
}

void write_output(const std::string& file, const std::string& text) {
    if (file.empty()) return;
    try {
        write_file(file, text);
    } catch (const std::exception& e) {
        throw std::runtime_error(fmt::format("cannot write \"{}\": {}", file, e.what()));
    }
}

// How far to trust a median.
std::string spread_text(double spread) {
    return fmt::format("{:.0f} %", 100 * spread);
}

void print_builds(const LabReport& report) {
    fmt::print("{:<26}{:>10}{:>8}{:>12}{:>12}{:>7}{:>10}{:>10}\n", "structure", "build", "spread",
               "bytes/tri", "nodes", "depth", "SAH cost", "overlap");
    for (const BuildRecord& b : report.builds)
        fmt::print("{:<26}{:>10}{:>8}{:>12.1f}{:>12}{:>7}{:>10.2f}{:>10.3f}\n", b.choice.name(),
                   timing_text(b.build_s), spread_text(b.build_spread), b.bytes_per_triangle, b.nodes,
                   b.depth, b.sah_cost, b.end_point_overlap);
}

void print_walks(const LabReport& report) {
    fmt::print("\n{:<26}{:<17}{:>9}{:>8}{:>8}{:>9}{:>8}{:>8}{:>8}{:>8}{:>7}\n", "structure", "rays", "single",
               "spread", "", "batch", "spread", "", "nodes", "leaves", "stack");
    auto ratio = [](const WalkRecord& w) {
        return w.peer_ratio ? fmt::format("{:.2f}x", *w.peer_ratio) : std::string();
    };
    for (std::size_t i = 0; i + 1 < report.walks.size(); i += 2) {
        const WalkRecord &single = report.walks[i], &batch = report.walks[i + 1];
        fmt::print("{:<26}{:<17}{:>9.2f}{:>8}{:>8}{:>9.2f}{:>8}{:>8}{:>8.1f}{:>8.1f}{:>7}\n",
                   report.builds[single.build].choice.name(),
                   fmt::format("{}, {}", name_of(single.rays), name_of(single.query)), single.mrays_per_s,
                   spread_text(single.spread), ratio(single), batch.mrays_per_s, spread_text(batch.spread),
                   ratio(batch), single.nodes_per_ray, single.leaves_per_ray, single.max_stack);
    }
    fmt::print("\nMillion rays a second, medians; the spread is from the slowest run to the fastest.\n");
    if (report.peer.empty())
        fmt::print("There is nothing to compare with: {}.\n", report.why_alone);
    else
        fmt::print("How many times as fast as {}, built for quality and called in its fastest way.\n",
                   report.peer);
}

int run_accel(AccelOptions& options) {
    std::vector<AccelChoice> choices = choices_of(options);
    check_outputs(options.scene, {options.json_file, options.html_file});
    if (!options.html_file.empty()) options.lab.heat_map_pixels = heat_map_pixels;
    Messages messages;
    messages.lenient = options.lenient;
    std::unique_ptr<World> world;
    with_threads(
        0, [&] { world = build_world(read_scene(options.scene, messages), options.settings, messages); });
    for (const Message& m : messages.warnings())
        if (!options.quiet) fmt::print(stderr, "{}\n", m.full_text());

    bool is_drawn = !options.quiet && stderr_is_terminal();
    LabReport report = measure(*world, options.scene, choices, options.lab, [&](const LabProgress& p) {
        if (!is_drawn) return;
        fmt::print(stderr, "\r{:3.0f} %  {}\x1b[K",
                   100.0 * static_cast<double>(p.done) / static_cast<double>(p.total), p.what);
        std::fflush(stderr);
    });
    if (is_drawn) fmt::print(stderr, "\r\x1b[K");
    write_output(options.json_file, to_json(report));
    write_output(options.html_file, to_html(report));
    if (options.quiet) return exit_ok;
    print_builds(report);
    print_walks(report);
    return exit_ok;
}

} // namespace

void add_accel_command(CLI::App& app, Action& action) {
    auto options = std::make_shared<AccelOptions>();
    CLI::App* command = app.add_subcommand("accel", "measure acceleration structures on a scene");
    command->add_option("SCENE", options->scene, "scene file (.pbrt)")->required();
    auto add_names = [&](const char* flag, std::vector<std::string>& names, const char* about) {
        command->add_option(flag, names, about)->type_name("NAME,...")->expected(1)->take_all();
    };
    add_names("--builder", options->builders, "how trees are built (default: every way)");
    add_names("--walk", options->walks, "how rays walk through them (default: every way)");
    command->add_option("--json", options->json_file, "write every number as JSON")->type_name("FILE");
    command->add_option("--html", options->html_file, "write a page with plots and heat maps")
        ->type_name("FILE");
    command->add_option("--rays", options->lab.rays.rays, "rays of each kind (default 100000)")
        ->check(CLI::Range(64, 1 << 26))
        ->type_name("N");
    command->add_option("--repeat", options->lab.repeat, "times each thing is timed (default 5)")
        ->check(CLI::Range(1, 1000))
        ->type_name("N");
    command->add_option("--threads", options->lab.threads, "how many threads (default 1; 0: all)")
        ->check(CLI::Range(0, 4096))
        ->type_name("N");
    command->add_option("--stack-entries", options->settings.stack_entries, "of the walk with a short stack")
        ->check(CLI::Range(1, 64))
        ->type_name("N");
    command->add_option("--seed", options->lab.rays.seed, "seed of the random rays")
        ->check(CLI::NonNegativeNumber)
        ->type_name("N");
    command->add_option("--camera", options->settings.camera, "use the camera of this name")
        ->type_name("NAME");
    command->add_flag("--lenient", options->lenient,
                      "replace what is unknown and say so, instead of stopping");
    command->add_flag("-q,--quiet", options->quiet, "print nothing but errors");
    command->callback([options, &action] { action = [options] { return run_accel(*options); }; });
}

} // namespace alhazen
