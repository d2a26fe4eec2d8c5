#include <fmt/format.h>

#include "benchmarks/accel/suite.h"
#include "lab/report.h"

namespace alhazen::bench {

Json bench_walking(World& world, const std::string& scene, const BenchOptions& options) {
    LabReport report = measure(world, scene, options.structures, options.lab);
    fmt::print("\n{}: {} triangles, {} thread(s), rays of each kind: {}\n", scene, report.triangles,
               report.threads, options.lab.rays.rays);
    if (report.peer.empty()) fmt::print("  no ratios: {}\n", report.why_alone);
    for (const BuildRecord& b : report.builds)
        fmt::print("  {:<24} build {:.3f} s, {:.1f} bytes/triangle, SAH {:.2f}\n", b.choice.name(), b.build_s,
                   b.bytes_per_triangle, b.sah_cost);
    for (const WalkRecord& w : report.walks) {
        std::string ratio = w.peer_ratio
                                ? fmt::format("x{:.2f} of {}, {:.3f} % agree", *w.peer_ratio, w.opponent,
                                              100 * (w.agreement->same + w.agreement->ties))
                                : "";
        fmt::print("  {:<24} {:<8} {:<8} {:<7} {:>8.2f} Mrays/s  {}\n", report.builds[w.build].choice.name(),
                   name_of(w.rays), name_of(w.query), name_of(w.mode), w.mrays_per_s, ratio);
    }
    return Json::parse(to_json(report));
}

} // namespace alhazen::bench
