/// alhazen compare: one scene seen by several integrators, side by side on one sheet.
#include <algorithm>
#include <cstdio>
#include <set>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "base/stopwatch.h"
#include "base/threads.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/progress.h"
#include "formats/format.h"
#include "image/caption.h"
#include "image/codec.h"
#include "image/metrics.h"
#include "lab/json_text.h"
#include "render/renderer.h"

namespace alhazen {

namespace {

struct CompareOptions {
    std::string scene, output = "compare.png", json_file;
    std::vector<std::string> ways;
    SceneOptions scene_options;
    bool quiet = false;
};

/// An integrator, and an acceleration structure where one was named: "path" or "path:lbvh/stack".
struct Way {
    std::string name, integrator;
    std::optional<AccelChoice> accel;

    explicit Way(const std::string& text) : name(text), integrator(text.substr(0, text.find(':'))) {
        if (!integrator_kinds().find(integrator))
            throw std::runtime_error(fmt::format("unknown integrator \"{}\"{}", integrator,
                                                 did_you_mean(integrator, integrator_kinds().names())));
        if (integrator.size() == text.size()) return;
        std::string error;
        accel = parse_accel(text.substr(integrator.size() + 1), error);
        if (!accel) throw std::runtime_error(fmt::format("\"{}\": {}", text, error));
    }
};

/// What came of it.
struct View {
    std::string name;
    Image image;
    double build_seconds = 0, render_seconds = 0;
    int samples = 0;
    double flip = 0; ///< difference to the last view's image
};

bool is_of_meshes(const std::deque<ShapeNode>& shapes) {
    return std::all_of(shapes.begin(), shapes.end(), [](const ShapeNode& s) {
        return s.node.type == "trianglemesh" || s.node.type == "plymesh";
    });
}

// What is compared when nobody says what: local light by rasterisation, Whitted's mirrors and glass, all
// light, and where every surface is a mesh all light through one distance field.
std::vector<std::string> usual_ways(const std::string& scene) {
    Messages messages;
    messages.lenient = true;
    const SceneDescription description = read_scene(scene, messages);
    std::vector<std::string> ways;
    // Other films want more than these give.
    if (description.film.type.empty() || description.film.type == "rgb") ways = {"raster", "whitted"};
    bool has_field = is_of_meshes(description.world.shapes) && !description.world.shapes.empty();
    for (const ObjectNode& object : description.objects) has_field = has_field && is_of_meshes(object.shapes);
    if (has_field) ways.emplace_back("path:sdf");
    ways.emplace_back("path");
    return ways;
}

View see(const CompareOptions& options, const Way& way, Messages& messages) {
    RenderSettings settings = options.scene_options.settings;
    settings.integrator = way.integrator;
    if (way.accel) settings.accel = way.accel;
    View view;
    view.name = way.name;
    const Stopwatch watch_build;
    std::unique_ptr<World> world;
    with_threads(settings.threads,
                 [&] { world = build_world(read_scene(options.scene, messages), settings, messages); });
    view.build_seconds = watch_build.seconds();
    ProgressBar bar(options.quiet);
    RenderWatch watch;
    watch.progress = [&](const Progress& p) { bar.update(p); };
    RenderStats stats = render(*world, settings, watch);
    bar.finish();
    view.render_seconds = stats.seconds;
    view.samples = stats.samples;
    view.image = world->film->image().to_rgb();
    return view;
}

void print_table(const std::vector<View>& views) {
    fmt::print("{:<18}{:>8}{:>14}{:>12}{:>18}\n", "integrator", "spp", "load, build s", "render s",
               "FLIP to " + views.back().name);
    for (const View& v : views)
        fmt::print("{:<18}{:>8}{:>14.3f}{:>12.3f}{:>18.4f}\n", v.name, v.samples, v.build_seconds,
                   v.render_seconds, v.flip);
}

std::string json_of(const std::string& scene, const std::vector<View>& views) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const View& v : views)
        json.push_back({{"scene", scene},
                        {"integrator", v.name},
                        {"samples_per_pixel", v.samples},
                        {"build_seconds", v.build_seconds},
                        {"render_seconds", v.render_seconds},
                        {"flip", v.flip},
                        {"flip_to", views.back().name}});
    return json_text(json);
}

// Renders all; a warning that several give is printed once.
std::vector<View> see_all(const CompareOptions& options, const std::vector<Way>& ways) {
    std::vector<View> views;
    std::set<std::string> said;
    for (const Way& way : ways) {
        Messages messages;
        messages.lenient = options.scene_options.lenient;
        views.push_back(see(options, way, messages));
        for (const Message& m : messages.warnings())
            if (std::string text = m.full_text(); !options.quiet && said.insert(text).second)
                fmt::print(stderr, "{}\n", text);
    }
    return views;
}

int run_compare(const CompareOptions& options) {
    check_picture_output(options.output);
    check_outputs(options.scene, {options.output, options.json_file});
    if (!options.scene_options.settings.integrator.empty())
        throw std::runtime_error("--integrator names one; compare takes several: --integrators raster,path");
    std::vector<Way> ways;
    for (const std::string& text : options.ways.empty() ? usual_ways(options.scene) : options.ways)
        ways.emplace_back(text);
    std::vector<View> views = see_all(options, ways);
    std::vector<Captioned> pictures;
    for (View& v : views) {
        v.flip = compute_metric(Metric::flip, v.image, views.back().image).value;
        pictures.push_back(
            {v.image, {v.name, fmt::format("{} spp, {}", v.samples, duration_text(v.render_seconds))}});
    }
    write_image(options.output, captioned_sheet(pictures), {});
    print_table(views);
    if (!options.json_file.empty()) write_file(options.json_file, json_of(options.scene, views));
    if (!options.quiet) fmt::print("{}: {} pictures side by side\n", options.output, views.size());
    return exit_ok;
}

} // namespace

void add_compare_command(CLI::App& app, Action& action) {
    auto options = std::make_shared<CompareOptions>();
    CLI::App* command = app.add_subcommand("compare", "see one scene by several integrators, side by side");
    command->add_option("SCENE", options->scene, "scene file (.pbrt)")->required();
    command
        ->add_option(
            "--integrators", options->ways,
            "which ones, an acceleration structure after a colon if wanted (path:lbvh/stack); the others are "
            "compared with the last (default: raster,whitted,path and, for meshes, path:sdf; for other films "
            "than rgb without the first two)")
        ->type_name("NAME,...")
        ->expected(1)
        ->take_all()
        ->delimiter(',');
    command->add_option("-o,--output", options->output, "the labelled picture")
        ->type_name("FILE")
        ->capture_default_str();
    command->add_option("--json", options->json_file, "write the table as JSON")->type_name("FILE");
    add_scene_options(*command, options->scene_options);
    command->add_flag("-q,--quiet", options->quiet, "print nothing but the table and errors");
    command->callback([options, &action] { action = [options] { return run_compare(*options); }; });
}

} // namespace alhazen
