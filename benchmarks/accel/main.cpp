/// bench_accel: acceleration structures against Embree on generated meshes and on scene files. See
/// docs/contributing.md.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/file.h"
#include "base/threads.h"
#include "benchmarks/accel/meshes.h"
#include "benchmarks/accel/suite.h"
#include "formats/format.h"
#include "lab/peer.h"

namespace alhazen::bench {
namespace {

struct Arguments {
    BenchOptions options;
    std::vector<std::string> meshes, files, structures, parts;
    std::string json, instructions, page, from;
    bool is_short = false;

    bool wants(std::string_view part) const {
        return parts.empty() || std::find(parts.begin(), parts.end(), part) != parts.end();
    }
};

void parse(CLI::App& app, int argc, char** argv, Arguments& a) {
    app.add_option("FILE", a.files, "scene files to measure as well (.pbrt)");
    app.add_option("--mesh", a.meshes, "generated meshes by name (default: all of the set)")->delimiter(',');
    app.add_option("--structure", a.structures, "BUILDER/WALK (default: what pictures are rendered with)")
        ->delimiter(',');
    app.add_option("--builder", a.options.builders, "whose times to build are compared")->delimiter(',');
    app.add_option("--part", a.parts, "walking, building, rendering (default: all)")->delimiter(',');
    app.add_option("--rays", a.options.lab.rays.rays, "of each kind");
    app.add_option("--repeat", a.options.lab.repeat, "times everything is timed");
    app.add_option("--instructions", a.instructions,
                   "plain, sse42, avx2 or avx512 where a walk has the choice");
    app.add_option("--threads", a.options.lab.threads, "for walking");
    app.add_option("--spp", a.options.spp, "samples per pixel of renders");
    app.add_option("--json", a.json, "write all records");
    app.add_option("--page", a.page, "put plots and figures into this page, between its marks");
    app.add_option("--from", a.from, "measure nothing; with --page: the records of an earlier run")
        ->needs("--page");
    app.add_flag("--short", a.is_short, "a set that takes a few minutes");
    app.parse(argc, argv);
    if (a.structures.empty()) a.options.structures = {AccelChoice{}};
    for (const std::string& text : a.structures) {
        std::string error;
        auto choice = parse_accel(text, error);
        if (!choice) throw CLI::ValidationError("--structure", error);
        a.options.structures.push_back(*choice);
    }
    for (const std::string& builder : a.options.builders) {
        std::string error;
        if (!parse_accel(builder, error)) throw CLI::ValidationError("--builder", error);
    }
    for (AccelChoice& choice : a.options.structures) choice.walk_options.instructions = a.instructions;
}

void bench_world(SceneDescription description, const std::string& name, const Arguments& a, Json& json) {
    Messages messages;
    messages.lenient = true;
    auto world = build_world(std::move(description), {}, messages);
    auto append = [&](const char* part, Json records) {
        for (Json& record : records) json[part].push_back(std::move(record));
    };
    if (a.wants("walking")) append("walking", bench_walking(*world, name, a.options));
    if (a.wants("building")) append("building", bench_building(*world, name, a.options));
    std::fflush(stdout);
}

// Geometric means of the ratios over all scenes, and the worst.
void print_means(const Json& records) {
    std::map<std::string, std::vector<double>> ratios;
    for (const Json& r : records) {
        if (r["embree_ratio"].is_null()) continue;
        auto text = [&](const char* key) { return r[key].get<std::string>(); };
        ratios[fmt::format("{}/{:<12} {:<8} {:<8} {}", text("builder"), text("walk"), text("rays"),
                           text("query"), text("mode"))]
            .push_back(r["embree_ratio"].get<double>());
    }
    if (!ratios.empty()) fmt::print("\nOver all scenes, times Embree: geometric mean, least\n");
    for (const auto& [what, values] : ratios) {
        double sum = 0;
        for (double v : values) sum += std::log(v);
        fmt::print("  {:<46}{:>6.2f}{:>6.2f}\n", what, std::exp(sum / static_cast<double>(values.size())),
                   *std::min_element(values.begin(), values.end()));
    }
}

// "AMD EPYC, 2 threads", as far as the system says.
std::string machine() {
    std::string model = "a processor of unknown name";
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.starts_with("model name")) {
            model = line.substr(line.find(':') + 2);
            break;
        }
    return fmt::format("{}, {} hardware threads", model, hardware_threads());
}

int run(const Arguments& a) {
    if (!a.from.empty()) {
        write_page(Json::parse(read_file(a.from)), a.page);
        return 0;
    }
    Json json{{"machine", machine()},
              {"peer", peer_library()},
              {"walking", Json::array()},
              {"building", Json::array()},
              {"rendering", Json::array()}};
    for (const GeneratedScene& scene : generated_scenes()) {
        bool named = std::find(a.meshes.begin(), a.meshes.end(), scene.name) != a.meshes.end();
        if (a.meshes.empty() ? a.is_short && !scene.is_short : !named) continue;
        bench_world(scene.make(), scene.name, a, json);
    }
    for (const std::string& file : a.files) {
        Messages messages;
        messages.lenient = true;
        bench_world(read_scene(file, messages), file, a, json);
        if (!a.wants("rendering")) continue;
        for (Json& record : bench_rendering(file, a.options)) json["rendering"].push_back(std::move(record));
    }
    print_means(json["walking"]);
    if (!a.json.empty()) write_file(a.json, json.dump(2) + "\n");
    if (!a.page.empty()) write_page(json, a.page);
    return 0;
}

} // namespace
} // namespace alhazen::bench

int main(int argc, char** argv) {
    CLI::App app("Measures acceleration structures.", "bench_accel");
    try {
        alhazen::bench::Arguments arguments;
        alhazen::bench::parse(app, argc, argv, arguments);
        return alhazen::bench::run(arguments);
    } catch (const CLI::ParseError& e) {
        return app.exit(e);
    } catch (const std::exception& e) {
        fmt::print(stderr, "bench_accel: {}\n", e.what());
        return 2;
    }
}
