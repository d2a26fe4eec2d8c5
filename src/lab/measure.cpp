#include "lab/measure.h"

#include <algorithm>

#include "base/threads.h"
#include "lab/opponents.h"
#include "lab/timing.h"

namespace alhazen {

namespace {

/// Rays that are counted, of each set.
constexpr std::size_t counted_rays = 20000;
/// Building is repeated for so many seconds, but not more often than tracing.
constexpr double build_seconds = 1;

/// What is asked: a set of rays with a question.
struct Task {
    const RaySet* set;
    Query query;
};

std::vector<Task> tasks_of(const std::vector<RaySet>& sets) {
    std::vector<Task> tasks;
    for (const RaySet& set : sets) {
        if (set.rays.empty()) continue;
        if (set.kind != RayKind::shadow) tasks.push_back({&set, Query::closest});
        if (set.kind != RayKind::primary) tasks.push_back({&set, Query::any});
    }
    return tasks;
}

class Lab {
  public:
    Lab(World& world, const LabOptions& options, LabReport& report,
        const std::function<void(const LabProgress&)>& progress)
        : scene_(*world.scene), world_(world), options_(options), report_(report), progress_(progress),
          sets_(make_ray_sets(world, options.rays)), tasks_(tasks_of(sets_)) {}

    void run(const std::vector<AccelChoice>& choices) {
        total_ = choices.size() * (tasks_.size() + 1);
        say("the opponent");
        opponents_ = std::make_unique<Opponents>(scene_.root(), options_.threads);
        for (const AccelChoice& choice : choices) {
            say(choice.name() + ", building");
            build(choice);
            if (options_.heat_map_pixels > 0)
                report_.visits.push_back(
                    count_visits(world_, tiled_size(world_.film->resolution(), options_.heat_map_pixels)));
            ++done_;
            for (const Task& task : tasks_) {
                say(choice.name() + ", " + std::string(name_of(task.set->kind)));
                walk(task);
                ++done_;
            }
        }
        report_.peer = opponents_->library();
        report_.why_alone = opponents_->why_none();
    }

  private:
    void say(std::string what) const {
        if (progress_) progress_({done_, total_, std::move(what)});
    }

    void build(const AccelChoice& choice) {
        BuildRecord record;
        record.choice = choice;
        std::vector<double> seconds;
        double sum = 0;
        while (seconds.empty() ||
               (sum < build_seconds && seconds.size() < static_cast<std::size_t>(options_.repeat))) {
            double s = 0;
            with_threads(options_.threads,
                         [&] { s = seconds_of(options_.threads, [&] { scene_.rebuild(choice); }); });
            seconds.push_back(s);
            sum += s;
        }
        record.build_s = median_of(seconds);
        record.build_spread = spread_of(seconds);
        SceneCounts counts = scene_.counts();
        std::size_t things = counts.triangles > 0 ? counts.triangles : counts.primitives;
        record.bytes_per_triangle =
            static_cast<double>(counts.accel_bytes) / static_cast<double>(std::max<std::size_t>(things, 1));
        record.nodes = counts.accel_nodes;
        record.depth = scene_.root().structure().stats().depth;
        Tree tree;
        with_threads(options_.threads, [&] { tree = build_tree(scene_.root(), choice); });
        record.sah_cost = stats_of(tree).sah_cost;
        record.end_point_overlap = end_point_overlap(tree, scene_.root());
        report_.builds.push_back(std::move(record));
    }

    void walk(const Task& task) {
        WalkRecord record;
        record.build = report_.builds.size() - 1;
        record.rays = task.set->kind;
        record.query = task.query;
        count(task, record);
        for (TraceMode mode : {TraceMode::single, TraceMode::batch}) {
            record.mode = mode;
            time(task, record);
            report_.walks.push_back(record);
        }
    }

    void count(const Task& task, WalkRecord& record) const {
        const std::vector<Ray>& rays = task.set->rays;
        std::size_t step = (rays.size() + counted_rays - 1) / counted_rays;
        WalkCounts counts;
        std::size_t counted = 0;
        for (std::size_t i = 0; i < rays.size(); i += step, ++counted)
            scene_.root().count(task.query, rays[i], counts);
        auto per_ray = [&](std::uint64_t n) { return static_cast<double>(n) / static_cast<double>(counted); };
        record.nodes_per_ray = per_ray(counts.nodes);
        record.leaves_per_ray = per_ray(counts.leaves);
        record.restarts_per_ray = per_ray(counts.restarts);
        record.max_stack = counts.max_stack;
    }

    // Ours and the peer's in turn, so that what else the machine does falls on both.
    void time(const Task& task, WalkRecord& record) {
        const std::vector<Ray>& rays = task.set->rays;
        const Opponent* peer = opponents_->fastest(task.set->kind, task.query, record.mode, rays);
        Answers ours, theirs;
        trace(scene_.root(), task.query, record.mode, rays, options_.threads, ours); // fills the caches
        std::vector<double> seconds, peer_seconds, ratios;
        for (int i = 0; i < options_.repeat; ++i) {
            if (peer)
                peer_seconds.push_back(
                    trace(*peer->peer, task.query, peer->call, rays, options_.threads, theirs));
            seconds.push_back(trace(scene_.root(), task.query, record.mode, rays, options_.threads, ours));
            if (peer) ratios.push_back(peer_seconds.back() / seconds.back());
        }
        auto mrays = [&](const std::vector<double>& s) {
            return static_cast<double>(rays.size()) / 1e6 / median_of(s);
        };
        record.mrays_per_s = mrays(seconds);
        record.spread = spread_of(seconds);
        if (!peer) return;
        record.peer_ratio = median_of(ratios);
        record.peer_mrays_per_s = mrays(peer_seconds);
        record.agreement = compare(task.query, ours, theirs);
        record.opponent = peer->name;
    }

    Scene& scene_;
    const World& world_;
    const LabOptions& options_;
    LabReport& report_;
    const std::function<void(const LabProgress&)>& progress_;
    std::vector<RaySet> sets_;
    std::vector<Task> tasks_;
    std::unique_ptr<Opponents> opponents_;
    std::size_t done_ = 0, total_ = 0;
};

} // namespace

LabReport measure(World& world, std::string scene, const std::vector<AccelChoice>& choices,
                  const LabOptions& options, const std::function<void(const LabProgress&)>& progress) {
    LabOptions used = options;
    if (used.threads == 0) used.threads = hardware_threads();
    LabReport report;
    report.scene = std::move(scene);
    SceneCounts counts = world.scene->counts();
    report.triangles = counts.triangles;
    report.primitives = counts.primitives;
    report.instances = counts.instances;
    report.threads = used.threads;
    report.repeat = used.repeat;
    report.primary_size = tiled_size(world.film->resolution(), used.rays.rays);
    if (used.heat_map_pixels > 0)
        report.view = headlight_view(world, tiled_size(world.film->resolution(), used.heat_map_pixels));
    Lab(world, used, report, progress).run(choices);
    return report;
}

} // namespace alhazen
