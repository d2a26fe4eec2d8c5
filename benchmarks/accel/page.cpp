#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include <fmt/format.h>

#include "base/file.h"
#include "benchmarks/accel/suite.h"
#include "benchmarks/page_marks.h"
#include "lab/bar_plot.h"
#include "lab/timing.h"

namespace alhazen::bench {

namespace {

std::string text(const Json& record, const char* key) {
    return record.at(key).get<std::string>();
}

// A scene file is called by its name alone.
std::string scene_of(const Json& record) {
    return std::filesystem::path(text(record, "scene")).stem().string();
}

/// Values that belong to scenes, in the order in which the scenes were measured.
struct Series {
    std::string label;
    std::vector<std::pair<std::string, double>> values;

    void add(const std::string& scene, const Json& value) {
        if (!value.is_null()) values.emplace_back(scene, value.get<double>());
    }
    std::optional<double> of(const std::string& scene) const {
        for (const auto& [name, value] : values)
            if (name == scene) return value;
        return std::nullopt;
    }
    double geometric_mean() const {
        double sum = 0;
        for (const auto& [name, value] : values) sum += std::log(value);
        return std::exp(sum / static_cast<double>(values.size()));
    }
    double least() const {
        double least = values.front().second;
        for (const auto& [name, value] : values) least = std::min(least, value);
        return least;
    }
};

/// What is asked of a walk: which rays, which question, how they are handed over.
struct Question {
    const char *label, *rays, *query, *mode;
};

Series ratios(const Json& records, const Question& q) {
    Series series{q.label, {}};
    for (const Json& r : records.at("walking"))
        if (text(r, "rays") == q.rays && text(r, "query") == q.query && text(r, "mode") == q.mode)
            series.add(scene_of(r), r.at("embree_ratio"));
    return series;
}

struct Contest {
    const char *builder, *quality;
};

// How many times as fast a builder is as one of the peer's qualities.
Series build_ratios(const Json& records, const Contest& contest, int threads) {
    Series series{fmt::format("{} against {}", contest.builder, contest.quality), {}};
    for (const Json& r : records.at("building"))
        if (text(r, "builder") == contest.builder && r.at("threads").get<int>() == threads)
            series.add(scene_of(r), r.at(fmt::format("embree_{}_ratio", contest.quality)));
    return series;
}

// How many times as fast two threads are as one.
Series thread_gains(const Json& records, const char* builder) {
    Series series{builder, {}};
    std::map<std::string, double> alone;
    for (const Json& r : records.at("building")) {
        if (text(r, "builder") != builder) continue;
        const double seconds = r.at("build_s").get<double>();
        if (r.at("threads").get<int>() == 1)
            alone[scene_of(r)] = seconds;
        else if (alone.count(scene_of(r)))
            series.add(scene_of(r), alone[scene_of(r)] / seconds);
    }
    return series;
}

Series render_ratios(const Json& records, const char* schedule) {
    Series series{schedule, {}};
    for (const Json& r : records.at("rendering"))
        if (text(r, "schedule") == schedule) series.add(scene_of(r), r.at("ratio"));
    return series;
}

BarPlot plot_of(std::string title, std::string unit, const std::vector<Series>& all, std::string mark) {
    constexpr const char* styles[] = {"first", "second", "third"};
    BarPlot plot;
    plot.title = std::move(title);
    plot.unit = std::move(unit);
    plot.marks.push_back({1, std::move(mark)});
    std::vector<std::string> scenes;
    for (const Series& series : all)
        for (const auto& [scene, value] : series.values)
            if (std::find(scenes.begin(), scenes.end(), scene) == scenes.end()) scenes.push_back(scene);
    auto row = [&](const std::string& label,
                   const std::function<std::optional<double>(const Series&)>& value) {
        BarPlot::Row bars{label, {}};
        for (std::size_t i = 0; i < all.size(); ++i)
            if (auto v = value(all[i]))
                bars.bars.push_back({*v, styles[i], fmt::format("{}: {:.2f}", all[i].label, *v)});
        plot.rows.push_back(std::move(bars));
    };
    for (const std::string& scene : scenes) row(scene, [&](const Series& s) { return s.of(scene); });
    if (scenes.size() > 1)
        row("geometric mean", [](const Series& s) { return std::optional(s.geometric_mean()); });
    for (std::size_t i = 0; i < all.size(); ++i) plot.keys.push_back({styles[i], all[i].label});
    return plot;
}

/// The page's figures, as they are put together.
class Figures {
  public:
    explicit Figures(std::filesystem::path page) : page_(std::move(page)) {}

    /// A plot of those series that have values, as a file beside the page, and a table of their means.
    void add(const std::string& name, const std::string& title, const std::string& unit,
             std::vector<Series> all, const std::string& mark) {
        std::erase_if(all, [](const Series& s) { return s.values.empty(); });
        if (all.empty()) return;
        const std::string file = "images/performance-" + name + ".svg";
        write_file(page_.parent_path() / file, plot_of(title, unit, all, mark).svg_file());
        text_ +=
            fmt::format("![{}]({})\n\n| {} | geometric mean | least |\n|---|---|---|\n", title, file, title);
        for (const Series& s : all)
            text_ += fmt::format("| {} | {:.2f} | {:.2f} |\n", s.label, s.geometric_mean(), s.least());
        text_ += "\n";
    }
    void say(const std::string& paragraph) { text_ += paragraph + "\n\n"; }
    /// Puts what there is in the place of what stood between the marks.
    void write() const { put_between_marks(page_, "figures", "\n" + text_); }

  private:
    std::filesystem::path page_;
    std::string text_;
};

// How large each scene is, and what its structures take.
std::string scenes_table(const Json& records) {
    std::string table =
        "| scene | triangles | bytes a triangle | SAH cost | nodes a diffuse ray | hits as Embree's |\n"
        "|---|---|---|---|---|---|\n";
    for (const Json& r : records.at("walking")) {
        if (text(r, "rays") != "diffuse" || text(r, "query") != "closest" || text(r, "mode") != "batch")
            continue;
        const Json& same = r.at("agreement");
        table += fmt::format("| {} | {} | {:.1f} | {:.1f} | {:.1f} | {} |\n", scene_of(r),
                             r.at("triangles").get<std::size_t>(), r.at("bytes_per_triangle").get<double>(),
                             r.at("sah_cost").get<double>(), r.at("nodes_per_ray").get<double>(),
                             same.is_null() ? ""
                                            : fmt::format("{:.3f} %", 100 * (same.get<double>() +
                                                                             r.at("ties").get<double>())));
    }
    return table;
}

} // namespace

void write_page(const Json& records, const std::filesystem::path& page) {
    std::filesystem::create_directories(page.parent_path() / "images");
    const std::string peer = text(records, "peer").empty() ? "Embree" : text(records, "peer");
    Figures figures(page);
    figures.say(fmt::format("Measured on {}, against {}.", text(records, "machine"), peer));
    figures.say(scenes_table(records));
    auto walking = [&](const std::string& name, const std::string& title,
                       const std::vector<Question>& questions) {
        std::vector<Series> all;
        for (const Question& q : questions) all.push_back(ratios(records, q));
        figures.add(name, title, "times Embree's rays a second", std::move(all), peer);
    };
    walking("batches", "Rays in batches",
            {{"diffuse bounces, nearest hit", "diffuse", "closest", "batch"},
             {"diffuse bounces, any hit", "diffuse", "any", "batch"},
             {"shadow rays, any hit", "shadow", "any", "batch"}});
    walking("single", "Rays from the camera, and one by one",
            {{"camera, in batches", "primary", "closest", "batch"},
             {"diffuse, one by one", "diffuse", "closest", "single"},
             {"ambient occlusion, one by one", "ao", "any", "single"}});
    for (int threads : {1, 2}) {
        std::vector<Series> all;
        for (const Contest& contest :
             {Contest{"lbvh", "low"}, Contest{"sah", "medium"}, Contest{"sbvh", "high"}})
            all.push_back(build_ratios(records, contest, threads));
        figures.add(fmt::format("building-{}", threads),
                    fmt::format("Building, {} thread{}", threads, threads == 1 ? "" : "s"),
                    "times Embree's builds a second", std::move(all), peer);
    }
    figures.add("threads", "Building on two threads", "times the builds a second of one thread",
                {thread_gains(records, "lbvh"), thread_gains(records, "sah"), thread_gains(records, "sbvh")},
                "one thread");
    figures.add("rendering", "Whole pictures, path integrator, two threads",
                "times the samples a second of single rays",
                {render_ratios(records, "batched"), render_ratios(records, "default")}, "one ray at a time");
    figures.write();
}

} // namespace alhazen::bench
