/// alhazen sdf: a mesh, or all surfaces of a scene, become a grid of signed distances.
#include <algorithm>
#include <cstdio>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/threads.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "cli/terminal.h"
#include "formats/format.h"
#include "formats/grids.h"
#include "render/surface_triangles.h"
#include "sdf/mesh_grid.h"

namespace alhazen {

namespace {

struct SdfOptions {
    std::string input, output;
    MeshGridOptions grid;
    SurfaceOptions surfaces;
    int threads = 0;
    bool lenient = false, quiet = false;
};

// Says what is wrong with the output before the work rather than after it.
void check_output(const std::string& file) {
    std::vector<std::string> known = grid_suffixes();
    std::string suffix = grid_suffix(file);
    if (suffix == ".nvdb" && !has_nanovdb())
        throw std::runtime_error(fmt::format("cannot write \"{}\": this program was built without NanoVDB "
                                             "(package libnanovdb-dev); .vol files work",
                                             file));
    if (std::find(known.begin(), known.end(), suffix) == known.end())
        throw std::runtime_error(
            fmt::format("cannot write \"{}\": the suffix must be one of {}", file, fmt::join(known, ", ")));
    check_output_folder(file);
}

bool is_mesh(std::filesystem::path file) {
    if (file.extension() == ".gz") file = file.stem();
    return grid_suffix(file) == ".ply";
}

std::vector<Corners> read_mesh(const std::string& file) {
    try {
        return mesh_triangles(file);
    } catch (const std::exception& e) {
        throw std::runtime_error(fmt::format("{}: {}", file, e.what()));
    }
}

std::vector<Corners> read_surfaces(const SdfOptions& options) {
    Messages messages;
    messages.lenient = options.lenient;
    SurfaceOptions surfaces = options.surfaces;
    surfaces.cells = options.grid.resolution;
    auto triangles = surface_triangles(read_scene(options.input, messages), surfaces, messages);
    if (!options.quiet)
        for (const Message& m : messages.warnings()) fmt::print(stderr, "{}\n", m.full_text());
    return triangles;
}

int run_sdf(SdfOptions& options) {
    check_output(options.output);
    bool is_dense = grid_suffix(options.output) == ".vol";
    if (is_dense) options.grid.is_full = true;
    bool is_drawn = !options.quiet && stderr_is_terminal();
    GridData data;
    bool is_stopped = false;
    with_threads(options.threads, [&] {
        options.grid.is_one_body = is_mesh(options.input);
        auto triangles = options.grid.is_one_body ? read_mesh(options.input) : read_surfaces(options);
        const InterruptWatch interrupt;
        data = sample_mesh(triangles, options.grid, [&](double fraction) {
            if (is_drawn) {
                fmt::print(stderr, "\rsampling: {:3.0f} %\x1b[K", 100 * fraction);
                std::fflush(stderr);
            }
            return !interrupt.interrupted();
        });
        is_stopped = interrupt.interrupted();
    });
    if (is_drawn) fmt::print(stderr, "\r\x1b[K");
    if (is_stopped) {
        fmt::print(stderr, "alhazen: stopped; nothing is written\n");
        return exit_interrupted;
    }
    try {
        write_grid(options.output, data);
    } catch (const std::exception& e) {
        throw std::runtime_error(fmt::format("cannot write \"{}\": {}", options.output, e.what()));
    }
    if (!options.quiet) {
        Vec3i n = data.hi - data.lo + Vec3i{1, 1, 1};
        fmt::print("{}: {} x {} x {} samples, {} bricks of 8 x 8 x 8 stored\n", options.output, n.x, n.y, n.z,
                   data.bricks.size());
    }
    return exit_ok;
}

} // namespace

void add_sdf_command(CLI::App& app, Action& action) {
    auto options = std::make_shared<SdfOptions>();
    CLI::App* command = app.add_subcommand("sdf", "make a grid of signed distances of a mesh or a scene");
    command
        ->add_option("MESH_OR_SCENE", options->input,
                     "mesh file (.ply), or scene file (.pbrt), whose surfaces become one grid")
        ->required();
    command
        ->add_option("-o,--output", options->output,
                     "grid file: .vol (dense) or .nvdb (sparse, where built with NanoVDB)")
        ->type_name("FILE")
        ->required();
    command
        ->add_option("--resolution", options->grid.resolution, "cells along the longest side (default 128)")
        ->check(CLI::Range(4, 2048))
        ->type_name("N");
    command
        ->add_option("--max-triangles", options->surfaces.most_triangles,
                     fmt::format("most that a scene's surfaces may become, instances repeated (default {})",
                                 options->surfaces.most_triangles))
        ->check(CLI::PositiveNumber)
        ->type_name("N");
    command->add_option("--band", options->grid.band, "cells on each side of the surface (default 3)")
        ->check(CLI::Range(2, 64))
        ->type_name("N");
    command->add_flag("--full", options->grid.is_full,
                      "sample everywhere, not in the band only; .vol always is");
    command->add_option("--threads", options->threads, "how many threads (default: all)")
        ->check(CLI::Range(0, 4096))
        ->type_name("N");
    command->add_flag("--lenient", options->lenient,
                      "replace what is unknown in a scene and say so, instead of stopping");
    command->add_flag("-q,--quiet", options->quiet, "print nothing but errors");
    command->callback([options, &action] { action = [options] { return run_sdf(*options); }; });
}

} // namespace alhazen
