/// validate: scenes against the images that another renderer made of them; see docs/validation.md.
#include <cstdio>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/file.h"
#include "benchmarks/validation/facts.h"
#include "benchmarks/validation/page.h"
#include "benchmarks/validation/record.h"
#include "image/codec.h"

namespace alhazen::bench {
namespace {

struct Arguments {
    ReferenceComparisonOptions options;
    std::string scenes = "../shared/scenes/pbrt";
    std::vector<std::string> only;
    std::string out = "build/validation", page;
    double minutes = 45;
    bool from_records = false;
};

void parse(CLI::App& app, int argc, char** argv, Arguments& a) {
    app.add_option("--scenes", a.scenes, "folder with the scenes");
    app.add_option("--only", a.only, "these scenes")->delimiter(',');
    app.add_option("--minutes", a.minutes, "for all of them, about");
    app.add_option("--seeds", a.options.seeds, "pictures of each")->check(CLI::Range(4, 64));
    app.add_option("--spp", a.options.spp, "samples per pixel of each picture (default: as time allows)");
    app.add_option("--integrator", a.options.integrator, "instead of the scenes' own");
    app.add_option("--out", a.out, "folder for pictures and records");
    app.add_option("--page", a.page, "put figures and pictures into this page, between its marks");
    app.add_flag("--from-records", a.from_records, "render nothing: the records in the folder are taken");
    app.parse(argc, argv);
}

std::vector<const SceneFacts*> wanted(const Arguments& a) {
    std::vector<const SceneFacts*> list;
    for (const SceneFacts& facts : validation_scenes())
        if (a.only.empty() || std::find(a.only.begin(), a.only.end(), facts.name) != a.only.end())
            list.push_back(&facts);
    return list;
}

void print(const ReferenceComparison& c, std::string_view verdict) {
    fmt::print("{:<18} {:4} x {} spp {:7.1f} CPU s  mean {:.4f} {:.4f} {:.4f} (+- {:.4f})  relMSE {:.4f} "
               "noise {:.4f} unexplained "
               "{:+.5f}  z2 {:.2f}, {:.1f} % beyond 4  FLIP {:.4f}  {}\n",
               c.scene, c.seeds, c.spp, c.cpu_seconds, c.mean_ratio[0], c.mean_ratio[1], c.mean_ratio[2],
               c.mean_ratio_error[1], c.errors.front().relmse, c.noise, c.unexplained, c.mean_z2,
               100 * c.beyond_four, c.flip, verdict);
    std::fflush(stdout);
}

/// Whether the scene is as its reference, but for what is known; records and pictures go into the folder.
bool compare(const std::filesystem::path& scenes, const SceneFacts& facts,
             const ReferenceComparisonOptions& options, const std::filesystem::path& out) {
    const ReferenceComparison c = compare_with_reference(scenes / facts.name, options);
    const std::string_view verdict = verdict_on(facts, agrees(c), c.mean_ratio, c.mean_z2);
    print(c, verdict);
    write_image(out / (c.scene + ".exr"), c.ours);
    write_image(out / (c.scene + ".png"), side_by_side(c));
    write_file(out / (c.scene + ".json"), to_json(c).dump(2) + "\n");
    return verdict != differs;
}

int run(Arguments a) {
    const std::filesystem::path scenes = a.scenes, out = a.out;
    if (!a.from_records && !std::filesystem::exists(scenes)) {
        fmt::print("The scenes are not there: {}\n", a.scenes);
        return 0;
    }
    std::filesystem::create_directories(out);
    const auto list = wanted(a);
    a.options.seconds = a.minutes * 60 / static_cast<double>(std::max<std::size_t>(list.size(), 1));
    bool all_agree = true;
    for (const SceneFacts* facts : list) {
        if (a.from_records) break;
        try {
            all_agree = compare(scenes, *facts, a.options, out) && all_agree;
        } catch (const std::exception& e) {
            // The others may do.
            fmt::print(stderr, "{}: error: {}\n", facts->name, e.what());
            all_agree = false;
        }
    }
    if (!a.page.empty()) write_validation_page(out, a.page);
    return all_agree ? 0 : 1;
}

} // namespace
} // namespace alhazen::bench

int main(int argc, char** argv) {
    using namespace alhazen::bench;
    CLI::App app("Scenes against images that another renderer made of them");
    Arguments arguments;
    try {
        parse(app, argc, argv, arguments);
        return run(arguments);
    } catch (const CLI::ParseError& e) {
        return app.exit(e);
    } catch (const std::exception& e) {
        fmt::print(stderr, "validate: error: {}\n", e.what());
        return 2;
    }
}
