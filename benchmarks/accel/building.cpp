#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "base/threads.h"
#include "benchmarks/accel/suite.h"
#include "lab/timing.h"

namespace alhazen::bench {

namespace {

constexpr std::pair<PeerQuality, const char*> qualities[] = {
    {PeerQuality::low, "low"}, {PeerQuality::medium, "medium"}, {PeerQuality::high, "high"}};

/// Builders to compare, each with the walk that is measured.
std::vector<AccelChoice> builders_of(const BenchOptions& options) {
    std::vector<AccelChoice> list;
    for (const std::string& builder : options.builders) {
        AccelChoice choice = options.structures.front();
        choice.builder = builder;
        list.push_back(choice);
    }
    return list;
}

/// By the peer's quality, the choice's name, or "tree " and that name: without the layout.
using Times = std::map<std::string, std::vector<double>>;

// All of ours and all of the peer's in turn, again and again.
Times measure_builds(const Object& root, const std::vector<AccelChoice>& ours, int threads, int repeat) {
    Times times;
    for (int i = 0; i < repeat; ++i) {
        for (auto [quality, name] : qualities)
            if (auto peer = make_peer(root, {quality, threads, false}))
                times[name].push_back(peer->build_seconds());
        for (const AccelChoice& choice : ours) {
            double tree_seconds = 0, layout_seconds = 0;
            with_threads(threads, [&] {
                Tree tree;
                std::unique_ptr<Structure> structure;
                tree_seconds = seconds_of(threads, [&] { tree = build_tree(root, choice); });
                layout_seconds = seconds_of(threads, [&] { structure = make_structure(root, tree, choice); });
            });
            times[choice.name()].push_back(tree_seconds + layout_seconds);
            times["tree " + choice.name()].push_back(tree_seconds);
        }
    }
    return times;
}

std::optional<double> ratio_of(const Times& times, const std::string& peer, const std::string& ours) {
    auto theirs = times.find(peer);
    if (theirs == times.end()) return std::nullopt;
    std::vector<double> ratios;
    const std::vector<double>& own = times.at(ours);
    for (std::size_t i = 0; i < own.size(); ++i) ratios.push_back(theirs->second[i] / own[i]);
    return median_of(ratios);
}

} // namespace

Json bench_building(World& world, const std::string& scene, const BenchOptions& options) {
    const Object& root = world.scene->root();
    std::vector<AccelChoice> ours = builders_of(options);
    Json records = Json::array();
    fmt::print("\n{}: building, seconds (and how many times as fast as {} low, medium, high)\n", scene,
               peer_library().empty() ? "nobody, as Embree is not installed," : peer_library());
    for (int threads : {1, 2}) {
        Times times = measure_builds(root, ours, threads, options.lab.repeat);
        for (const AccelChoice& choice : ours) {
            Json record{{"scene", scene},
                        {"builder", choice.builder},
                        {"walk", choice.walk},
                        {"threads", threads},
                        {"triangles", root.count()},
                        {"build_s", median_of(times[choice.name()])},
                        {"tree_s", median_of(times["tree " + choice.name()])},
                        {"spread", spread_of(times[choice.name()])},
                        {"sah_cost", stats_of(build_tree(root, choice)).sah_cost}};
            std::string text;
            for (auto [quality, name] : qualities) {
                auto ratio = ratio_of(times, name, choice.name());
                record[fmt::format("embree_{}_ratio", name)] = ratio ? Json(*ratio) : Json();
                text += ratio ? fmt::format("  x{:.2f}", *ratio) : "";
            }
            fmt::print("  {} thread(s)  {:<20}{:>8.3f} s (tree {:.3f})  SAH {:>7.2f}{}\n", threads,
                       choice.name(), record["build_s"].get<double>(), record["tree_s"].get<double>(),
                       record["sah_cost"].get<double>(), text);
            records.push_back(std::move(record));
        }
    }
    return records;
}

} // namespace alhazen::bench
