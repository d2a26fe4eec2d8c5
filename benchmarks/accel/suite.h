/// The parts of the benchmark. Each prints a table as it goes and returns its records.
#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "lab/measure.h"

namespace alhazen::bench {

using Json = nlohmann::ordered_json;

struct BenchOptions {
    std::vector<AccelChoice> structures; ///< that are walked
    /// Builders whose times are compared with the peer's; the others are methods to study, not to compete.
    std::vector<std::string> builders{"sah", "sbvh", "lbvh", "ploc"};
    LabOptions lab;
    /// Samples per pixel of whole renders, and how often each is repeated.
    int spp = 4, render_repeat = 3;
};

/// The structures' speed with each kind of rays, over the peer's.
Json bench_walking(World& world, const std::string& scene, const BenchOptions& options);

/// Times to build, ours over the peer's three qualities, on 1 and 2 threads.
Json bench_building(World& world, const std::string& scene, const BenchOptions& options);

/// Whole pictures, with each way of handing rays to the structure.
Json bench_rendering(const std::string& file, const BenchOptions& options);

/// Turns the records of a run (the JSON that bench_accel writes) into plots beside a page, and the page's
/// figures: what stands between its two marks. Throws SceneError or std::exception when the page or the
/// records are not as expected.
void write_page(const Json& records, const std::filesystem::path& page);

} // namespace alhazen::bench
