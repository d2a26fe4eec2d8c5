/// ablations: what the path tracer's choices are worth, one by one, at equal time; see docs/performance.md.
#include <cmath>
#include <cstdio>
#include <map>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "benchmarks/page_marks.h"
#include "benchmarks/validation/facts.h"
#include "lab/reference_comparison.h"

namespace alhazen::bench {
namespace {

struct Arguments {
    ReferenceComparisonOptions options;
    std::string scenes = "../shared/scenes/pbrt", page;
    std::vector<std::string> only;
};

/// One thing that is done in another way.
struct Change {
    std::string name;
    std::function<void(SceneDescription&)> apply;
};

Change other_sampler(const std::string& type) {
    return {"sampler " + type, [type](SceneDescription& scene) {
                scene.sampler = {};
                scene.sampler.type = type;
            }};
}

/// A parameter of the path tracer.
Change other_rule(std::string name, Parameter parameter) {
    return {std::move(name), [parameter = std::move(parameter)](SceneDescription& scene) {
                set_path_parameter(scene, parameter);
            }};
}

Change other_light_sampler(const std::string& name) {
    return other_rule("lights by " + name, make_string("lightsampler", name));
}

Change other_roulette(float threshold) {
    return other_rule(fmt::format("roulette below {:g}", threshold),
                      make_float("roulettethreshold", threshold));
}

/// Light of the sky is drawn as if no BSDF found it, too.
Change without_compensation() {
    return {"without MIS compensation", [](SceneDescription& scene) {
                for (LightNode& light : scene.lights)
                    if (light.node.type == "infinite") light.node.set(make_bool("compensate", false));
            }};
}

/// The first is the default.
std::vector<Change> changes() {
    return {other_sampler("zsobol"),  other_sampler("independent"), other_sampler("stratified"),
            other_sampler("halton"),  other_sampler("sobol"),       other_sampler("paddedsobol"),
            other_sampler("pmj02bn"), other_light_sampler("power"), other_light_sampler("uniform"),
            other_roulette(1),        other_roulette(0.06f),        without_compensation()};
}

/// Noise times processor seconds.
double work(const std::filesystem::path& folder, ReferenceComparisonOptions options, const Change& change) {
    options.change = [&](SceneDescription& scene) {
        scene.sampler = {};
        scene.sampler.type = "zsobol";
        change.apply(scene);
    };
    const ReferenceComparison c = compare_with_reference(folder, options);
    return c.noise * (c.cpu_seconds - c.load_seconds);
}

std::string measure(const Arguments& a) {
    const std::vector<Change> all = changes();
    std::map<std::string, std::vector<double>> ratios; // by change, a scene each
    std::vector<std::string> names;
    for (const SceneFacts& facts : validation_scenes()) {
        if (!a.only.empty() && std::find(a.only.begin(), a.only.end(), facts.name) == a.only.end()) continue;
        names.push_back(facts.name);
        const std::filesystem::path folder = std::filesystem::path(a.scenes) / facts.name;
        std::vector<double> works;
        for (const Change& change : all) works.push_back(work(folder, a.options, change));
        // The machine may have become slower or faster meanwhile.
        const double standard = std::sqrt(works.front() * work(folder, a.options, all.front()));
        for (std::size_t i = 1; i < all.size(); ++i) ratios[all[i].name].push_back(works[i] / standard);
        fmt::print("{}", facts.name);
        for (std::size_t i = 1; i < all.size(); ++i)
            fmt::print("  {} {:.2f}", all[i].name, works[i] / standard);
        fmt::print("\n");
        std::fflush(stdout);
    }
    std::string table = fmt::format(
        "\n{} samples a pixel, {} seeds.\n\n| instead of zsobol, lights by tree, roulette below 0.25 |",
        a.options.spp, a.options.seeds);
    for (const std::string& name : names) table += " " + name + " |";
    table += " geometric mean |\n|---|";
    for (std::size_t i = 0; i <= names.size(); ++i) table += "---|";
    for (std::size_t i = 1; i < all.size(); ++i) {
        double logs = 0;
        table += "\n| " + all[i].name + " |";
        for (double ratio : ratios[all[i].name]) {
            table += fmt::format(" {:.2f} |", ratio);
            logs += std::log(ratio);
        }
        table += fmt::format(" {:.2f} |",
                             std::exp(logs / static_cast<double>(std::max<std::size_t>(names.size(), 1))));
    }
    return table + "\n\n";
}

int run(const Arguments& a) {
    if (!std::filesystem::exists(a.scenes)) {
        fmt::print("The scenes are not there: {}\n", a.scenes);
        return 0;
    }
    const std::string table = measure(a);
    fmt::print("{}", table);
    if (!a.page.empty()) put_between_marks(a.page, "ablations", table);
    return 0;
}

} // namespace
} // namespace alhazen::bench

int main(int argc, char** argv) {
    using namespace alhazen::bench;
    CLI::App app("What the path tracer's choices are worth at equal time");
    Arguments a;
    a.options.spp = 16;
    a.options.seeds = 4;
    app.add_option("--scenes", a.scenes, "folder with the scenes");
    app.add_option("--only", a.only, "these scenes")->delimiter(',');
    app.add_option("--seeds", a.options.seeds, "pictures of each")->check(CLI::Range(4, 64));
    app.add_option("--spp", a.options.spp, "samples per pixel of each picture")->check(CLI::Range(1, 4096));
    app.add_option("--page", a.page, "put the table into this page, between its marks");
    try {
        app.parse(argc, argv);
        return run(a);
    } catch (const CLI::ParseError& e) {
        return app.exit(e);
    } catch (const std::exception& e) {
        fmt::print(stderr, "ablations: error: {}\n", e.what());
        return 2;
    }
}
