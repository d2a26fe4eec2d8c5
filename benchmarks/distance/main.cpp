/// bench_distance SCENE...: accelerator "sdf" beside exact tracing. Prints, for each scene and number of
/// cells, how far the picture is from an exact one with another seed (and how far two exact ones are from
/// each other, which is the noise), what building the field takes, and how many times as fast the picture is
/// made; and how many times as fast rays alone are answered, as a path tracer would ask for them.
#include <array>
#include <span>
#include <vector>

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "formats/format.h"
#include "image/metrics.h"
#include "lab/ray_sets.h"
#include "lab/timing.h"
#include "render/renderer.h"

namespace alhazen::bench {

namespace {

struct Options {
    std::vector<std::string> scenes;
    std::vector<int> cells{64, 128, 256};
    std::string integrator = "path";
    int spp = 32, repeat = 3;
    Vec2i size{320, 240};
};

struct Made {
    Image image;
    double build_s = 0, render_s = 0; ///< processor time
};

Made make(const std::string& file, const Options& options, int cells, std::uint64_t seed) {
    Messages messages;
    messages.lenient = true;
    RenderSettings settings;
    settings.spp = options.spp;
    settings.size = options.size;
    settings.integrator = options.integrator;
    settings.seed = seed;
    AccelChoice accel;
    accel.distance_field = cells;
    settings.accel = accel;
    Made made;
    std::unique_ptr<World> world;
    SceneDescription description = read_scene(file, messages);
    made.build_s =
        processor_seconds_of([&] { world = build_world(std::move(description), settings, messages); });
    made.render_s = processor_seconds_of([&] { render(*world, settings, {}); });
    made.image = world->film->image();
    return made;
}

void print_error(const std::string& name, const Image& image, const Image& reference) {
    fmt::print("  {:<22}relMSE {:<10.4g} FLIP {:<8.4f}", name, relmse(image, reference).value,
               flip(image, reference).value);
}

/// Answers many rays as integrators' queues do, and keeps what came out, so that it must be found.
struct Answers {
    static constexpr std::size_t batch = 256;

    explicit Answers(const RaySet& set_) : set(set_), t(set_.rays.size()) {}

    template <class Closest, class Blocked>
    double time(const Closest& closest, const Blocked& blocked) {
        return processor_seconds_of([&] {
            for (std::size_t first = 0; first < t.size(); first += batch) {
                const std::span rays(&set.rays[first], std::min(batch, t.size() - first));
                if (set.kind == RayKind::diffuse) {
                    closest(rays, std::span(found.data(), rays.size()));
                    for (std::size_t i = 0; i < rays.size(); ++i) {
                        const auto hit = Scene::surface(found[i]);
                        t[first + i] = hit ? hit->t : infinity;
                    }
                } else {
                    blocked(rays, std::span(is_blocked.data(), rays.size()));
                    for (std::size_t i = 0; i < rays.size(); ++i) t[first + i] = is_blocked[i] ? 0 : infinity;
                }
            }
        });
    }

    const RaySet& set;
    std::vector<float> t;
    std::array<Found, batch> found;
    std::array<std::uint8_t, batch> is_blocked{};
};

void compare_rays(const std::string& file, const Options& options, int cells) {
    Messages messages;
    messages.lenient = true;
    auto world = build_world(read_scene(file, messages), {}, messages);
    world->scene->approximate(cells);
    const Scene& scene = *world->scene;
    const DistanceScene& field = *scene.approximation();
    const float cell = max_component(scene.bounds().diagonal()) / static_cast<float>(cells);
    for (const RaySet& set : make_ray_sets(*world)) {
        if (set.kind == RayKind::primary || set.rays.empty()) continue;
        Answers exact(set), approximate(set);
        std::vector<Intersection> hits;
        std::vector<double> ratios;
        for (int i = 0; i < 2 * options.repeat + 1; ++i) {
            const double exact_s = exact.time(
                [&](std::span<const Ray> rays, std::span<Found> found) {
                    hits.assign(rays.size(), Intersection{});
                    scene.closest(rays, hits, found);
                },
                [&](std::span<const Ray> rays, std::span<std::uint8_t> blocked) {
                    scene.blocked(rays, blocked);
                });
            ratios.push_back(
                exact_s / approximate.time([&](auto rays, auto found) { field.closest(rays, found); },
                                           [&](auto rays, auto blocked) { field.blocked(rays, blocked); }));
        }
        std::size_t same = 0;
        for (std::size_t i = 0; i < exact.t.size(); ++i)
            same += exact.t[i] == approximate.t[i] ||
                    std::abs(exact.t[i] - approximate.t[i]) * length(set.rays[i].d) < cell;
        fmt::print(
            "  {:<8} rays alone       {:.1f} % end within a cell of where they should; x{:.2f} as fast "
            "(spread {:.2f})\n",
            name_of(set.kind), 100.0 * static_cast<double>(same) / static_cast<double>(exact.t.size()),
            median_of(ratios), spread_of(ratios));
    }
}

void compare(const std::string& file, const Options& options) {
    fmt::print("{}: {} x {}, {} samples a pixel, {}; processor time\n", file, options.size.x, options.size.y,
               options.spp, options.integrator);
    Made reference = make(file, options, 0, 1);
    print_error("exact, another seed", make(file, options, 0, 2).image, reference.image);
    fmt::print("\n");
    for (int cells : options.cells) {
        std::vector<double> ratios, builds;
        Image image;
        // In turn, so that whatever else the machine does falls on both.
        for (int i = 0; i < options.repeat; ++i) {
            Made exact = make(file, options, 0, 2), field = make(file, options, cells, 2);
            ratios.push_back(exact.render_s / field.render_s);
            builds.push_back(field.build_s - exact.build_s);
            image = field.image;
        }
        print_error(fmt::format("field of {} cells", cells), image, reference.image);
        fmt::print("x{:.2f} as fast (spread {:.2f}), built in {:.2f} s\n", median_of(ratios),
                   spread_of(ratios), median_of(builds));
        compare_rays(file, options, cells);
    }
}

} // namespace

} // namespace alhazen::bench

int main(int argc, char** argv) {
    using namespace alhazen::bench;
    CLI::App app("Accelerator \"sdf\" beside exact tracing.", "bench_distance");
    Options options;
    app.add_option("SCENE", options.scenes, "scene files of triangles")->required();
    app.add_option("--cells", options.cells, "cells along the longest side");
    app.add_option("--integrator", options.integrator, "integrator");
    app.add_option("--spp", options.spp, "samples a pixel");
    app.add_option("--repeat", options.repeat, "times each is timed");
    CLI11_PARSE(app, argc, argv);
    try {
        for (const std::string& scene : options.scenes) compare(scene, options);
    } catch (const std::exception& e) {
        fmt::print(stderr, "bench_distance: {}\n", e.what());
        return 2;
    }
    return 0;
}
