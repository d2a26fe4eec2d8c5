#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "base/base64.h"
#include "image/codec.h"
#include "image/metrics.h"
#include "lab/bar_plot.h"
#include "lab/html_style.h"
#include "lab/report.h"
#include "lab/timing.h"

namespace alhazen {

namespace {

std::string section(std::string_view title, std::string_view body) {
    return fmt::format("<section>\n<h2>{}</h2>\n{}</section>\n", title, body);
}

// What a question is called in titles.
std::string title_of(RayKind kind, Query query) {
    std::string what;
    switch (kind) {
    case RayKind::primary:
        what = "Rays from the camera";
        break;
    case RayKind::diffuse:
        what = "Diffuse bounces";
        break;
    case RayKind::ao:
        what = "Ambient occlusion";
        break;
    case RayKind::shadow:
        what = "Shadow rays";
        break;
    }
    return what + (query == Query::closest ? ": the nearest hit" : ": is there any hit?");
}

// The walks with these rays and this question, in the order of the builds: single, batch, single, batch ...
std::vector<const WalkRecord*> select(const LabReport& report, RayKind kind, Query query, TraceMode mode) {
    std::vector<const WalkRecord*> found;
    for (const WalkRecord& w : report.walks)
        if (w.rays == kind && w.query == query && w.mode == mode) found.push_back(&w);
    return found;
}

std::string tip(const LabReport& report, const WalkRecord& w) {
    std::string text = fmt::format("{}, {}: {:.2f} Mrays/s", report.builds[w.build].choice.name(),
                                   w.mode == TraceMode::batch ? "batches" : "ray by ray", w.mrays_per_s);
    if (w.peer_ratio) text += fmt::format(", {:.2f} times {}", *w.peer_ratio, w.opponent);
    return text + fmt::format("; {:.1f} nodes and {:.1f} leaves a ray", w.nodes_per_ray, w.leaves_per_ray);
}

// Where the peer stands: the median of its speeds beside all builds.
std::optional<BarPlot::Mark> peer_mark(const LabReport& report, const std::vector<const WalkRecord*>& walks) {
    std::vector<double> speeds;
    for (const WalkRecord* w : walks)
        if (w->peer_mrays_per_s) speeds.push_back(*w->peer_mrays_per_s);
    if (speeds.empty()) return std::nullopt;
    return BarPlot::Mark{median_of(speeds), report.peer};
}

std::string speed_plot(const LabReport& report, RayKind kind, Query query) {
    auto single = select(report, kind, query, TraceMode::single);
    auto batch = select(report, kind, query, TraceMode::batch);
    if (single.empty()) return "";
    BarPlot plot;
    plot.title = title_of(kind, query);
    plot.unit = "million rays a second";
    for (std::size_t i = 0; i < single.size(); ++i)
        plot.rows.push_back({report.builds[single[i]->build].choice.name(),
                             {{batch[i]->mrays_per_s, "batch", tip(report, *batch[i])},
                              {single[i]->mrays_per_s, "single", tip(report, *single[i])}}});
    if (auto mark = peer_mark(report, batch)) plot.marks.push_back(*mark);
    return fmt::format("<figure><figcaption>{}</figcaption>\n{}</figure>\n", escape_html(plot.title),
                       plot.svg());
}

std::string speeds_section(const LabReport& report) {
    std::string plots;
    for (RayKind kind : {RayKind::primary, RayKind::diffuse, RayKind::ao, RayKind::shadow})
        for (Query query : {Query::closest, Query::any}) plots += speed_plot(report, kind, query);
    std::string peer =
        report.peer.empty()
            ? fmt::format("There is no other library to compare with: {}.", escape_html(report.why_alone))
            : fmt::format(
                  "The dashed line is {}, built for quality, called in the way that is fastest for these "
                  "rays (each way was tried: single rays and packets of 16, with its best instruction set "
                  "and with AVX2), and measured in turn with ours.",
                  escape_html(report.peer));
    return section(
        "How fast?",
        fmt::format("<p>Longer is better. <span class=\"key batch\"></span> many rays handed over at a "
                    "time ({} in a batch), <span class=\"key single\"></span> one by one; medians of {} "
                    "runs, on {} thread{}. {}</p>\n<div class=\"plots\">{}</div>\n",
                    batch_size, report.repeat, report.threads, report.threads == 1 ? "" : "s", peer, plots));
}

std::string build_plot(const LabReport& report, std::string title, std::string unit,
                       double (*value)(const BuildRecord&)) {
    BarPlot plot;
    plot.title = title;
    plot.unit = std::move(unit);
    for (const BuildRecord& b : report.builds)
        plot.rows.push_back(
            {b.choice.name(), {{value(b), "build", fmt::format("{}: {:.4g}", b.choice.name(), value(b))}}});
    return fmt::format("<figure><figcaption>{}</figcaption>\n{}</figure>\n", escape_html(title), plot.svg());
}

std::string builds_section(const LabReport& report) {
    std::string rows;
    for (const BuildRecord& b : report.builds)
        rows +=
            fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{:.0f} %</td><td>{:.1f}</td><td>{}</td>"
                        "<td>{}</td><td>{:.2f}</td><td>{:.3f}</td></tr>\n",
                        escape_html(b.choice.name()), timing_text(b.build_s), 100 * b.build_spread,
                        b.bytes_per_triangle, b.nodes, b.depth, b.sah_cost, b.end_point_overlap);
    std::string plots =
        build_plot(report, "Time to build", "seconds", [](const BuildRecord& b) { return b.build_s; }) +
        build_plot(report, "Memory", "bytes a triangle",
                   [](const BuildRecord& b) { return b.bytes_per_triangle; });
    return section("What does it cost?",
                   "<p>The surface area heuristic's cost is how many nodes and primitives a random ray that "
                   "crosses the scene "
                   "is expected to meet (MacDonald and Booth 1990). End-point overlap is what that leaves "
                   "out: how much surface "
                   "lies in boxes it does not belong to, where rays start and end (Aila, Karras and Laine "
                   "2013). Less is "
                   "better, everywhere on this table.</p>\n<div class=\"plots\">" +
                       plots +
                       "</div>\n<div class=\"wide\"><table>\n<thead><tr><th>builder/walk</th><th>build</th>"
                       "<th>spread</th><th>bytes a "
                       "triangle</th><th>nodes</th><th>depth</th><th>SAH "
                       "cost</th><th>overlap</th></tr></thead>\n<tbody>" +
                       rows + "</tbody></table></div>\n");
}

// One scale for all pictures: what 995 of 1000 pixels stay below.
float scale_of(const std::vector<Image>& visits) {
    std::vector<float> all;
    for (const Image& image : visits) all.insert(all.end(), image.values().begin(), image.values().end());
    if (all.empty()) return 1;
    auto high = all.begin() + static_cast<std::ptrdiff_t>(static_cast<double>(all.size() - 1) * 0.995);
    std::nth_element(all.begin(), high, all.end());
    return std::max(1.0f, std::ceil(*high));
}

// Half as bright is a quarter of the visits: wide trees, which visit few, are to be seen beside binary ones.
Image of_visits(Image image, float most) {
    for (float& visits : image.values()) visits = std::sqrt(visits / most);
    return image;
}

std::string legend(float most) {
    std::string stops;
    for (int i = 0; i <= 8; ++i) {
        Vec3 c = magma_srgb(static_cast<float>(i) / 8) * 255;
        stops += fmt::format("<stop offset=\"{}\" stop-color=\"rgb({:.0f},{:.0f},{:.0f})\"/>", i / 8.0, c.x,
                             c.y, c.z);
    }
    return fmt::format(
        "<svg class=\"legend\" viewBox=\"0 0 420 44\" role=\"img\" aria-label=\"colour scale\"><defs>"
        "<linearGradient id=\"magma\">{}</linearGradient></defs><rect x=\"10\" y=\"4\" width=\"400\" "
        "height=\"16\" fill=\"url(#magma)\"/><text class=\"tick\" x=\"14\" y=\"36\">0</text><text "
        "class=\"tick\" x=\"210\" y=\"36\">{:g} nodes visited</text><text class=\"tick end\" x=\"410\" "
        "y=\"36\">{:g} or more</text></svg>\n",
        stops, most / 4, most);
}

// An image and what is said below it; caption is HTML.
std::string picture(const Image& image, std::string_view alt, std::string_view caption) {
    return fmt::format("<figure><img alt=\"{}\" width=\"{}\" height=\"{}\" src=\"data:image/png;base64,{}\">"
                       "<figcaption>{}</figcaption></figure>\n",
                       alt, image.width(), image.height(), base64(encode_image(".png", image)), caption);
}

std::string visits_section(const LabReport& report) {
    if (report.visits.empty()) return "";
    float most = scale_of(report.visits);
    std::string figures;
    std::set<std::string> walks;
    for (std::size_t i = 0; i < report.visits.size(); ++i) {
        const Image& image = report.visits[i];
        double sum = 0;
        for (float v : image.values()) sum += static_cast<double>(v);
        std::string name = escape_html(report.builds[i].choice.name());
        figures += picture(heat_map(of_visits(image, most), 1), "nodes visited by " + name,
                           fmt::format("{}<br><small>{:.1f} a ray</small>", name,
                                       sum / static_cast<double>(image.values().size())));
        walks.insert(report.builds[i].choice.walk);
    }
    return section(
        "Where do rays spend their time?",
        "<div class=\"view\">" + picture(report.view, "the scene", "What the camera sees") +
            "<p>The same view through each structure: the brighter a pixel, the more nodes the ray through "
            "it visited (half as bright: a quarter of the nodes). All pictures have the same scale. Edges "
            "glow: a ray that just misses things looks "
            "into many boxes and finds nothing there. A node with four or eight children decides more at a "
            "time, so wide trees visit fewer, each of which costs more.</p></div>\n" +
            legend(most) +
            fmt::format("<div class=\"wide\"><div class=\"maps\" style=\"grid-template-columns:"
                        "repeat({},minmax(8rem,1fr))\">{}</div></div>\n",
                        walks.size(), figures));
}

std::string methods_section(const LabReport& report) {
    std::vector<std::string> builders, walks;
    auto add = [](std::vector<std::string>& list, const std::string& name) {
        if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
    };
    for (const BuildRecord& b : report.builds) {
        add(builders, b.choice.builder);
        add(walks, b.choice.walk);
    }
    std::string text = "<h3>How the tree is built</h3>\n<dl>";
    for (const std::string& name : builders)
        text +=
            fmt::format("<dt>{}</dt><dd>{}</dd>\n", escape_html(name), escape_html(explain_builder(name)));
    text += "</dl>\n<h3>How a ray walks through it</h3>\n<dl>";
    for (const std::string& name : walks)
        text += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escape_html(name), escape_html(explain_walk(name)));
    return section(
        "What is compared?",
        "<p>A scene of many triangles is kept in a tree of boxes, so that a ray looks only into the boxes "
        "it meets. A <em>builder</em> decides which triangles share a box; a <em>walk</em> lays the tree "
        "out in memory and leads rays through it. Any of them go together.</p>\n" +
            text + "</dl>\n");
}

std::string walks_section(const LabReport& report) {
    std::string rows;
    for (const WalkRecord& w : report.walks) {
        std::string ratio = w.peer_ratio ? fmt::format("{:.2f}", *w.peer_ratio) : "";
        std::string same =
            w.agreement ? fmt::format("{:.3f} %", 100 * (w.agreement->same + w.agreement->ties)) : "";
        rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{} {}</td><td>{}</td><td>{:.2f}</td><td>{:.0f} "
                            "%</td><td>{}</td>"
                            "<td>{}</td><td>{:.1f}</td><td>{:.1f}</td><td>{:.2f}</td><td>{}</td></tr>\n",
                            escape_html(report.builds[w.build].choice.name()), name_of(w.rays),
                            name_of(w.query), name_of(w.mode), w.mrays_per_s, 100 * w.spread, ratio, same,
                            w.nodes_per_ray, w.leaves_per_ray, w.restarts_per_ray, w.max_stack);
    }
    return section(
        "All the numbers",
        "<p>Medians; the spread is from the slowest run to the fastest. Nodes, leaves, restarts "
        "(of walks without a full stack) are visits a ray; the stack is the most entries that "
        "any ray had on it.</p>\n"
        "<details><summary>Every builder, walk, kind of rays and way to hand them over</summary><div "
        "class=\"wide\"><table>\n<thead><tr><th>builder/walk</th><th>rays</th><th>mode</th><th>Mrays/s</th>"
        "<th>spread</th><th>ratio</th><th>agree</th><th>nodes</th><th>leaves</th><th>restarts</th>"
        "<th>stack</th></tr></thead>\n<tbody>" +
            rows + "</tbody></table></div></details>\n");
}

} // namespace

std::string to_html(const LabReport& report) {
    std::string scene = escape_html(report.scene);
    std::string head =
        fmt::format("<header><h1>Finding what a ray meets</h1>\n<p>{}: {} triangles, {} primitives, {} "
                    "instances. {} structures, compared by Alhazen's laboratory.</p></header>\n",
                    scene, report.triangles, report.primitives, report.instances, report.builds.size());
    return fmt::format(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
        "content=\"width=device-width, initial-scale=1\">\n<title>Acceleration structures: {}</title>\n"
        "<style>\n{}</style>\n</head>\n<body>\n{}{}{}{}{}{}</body>\n</html>\n",
        scene, html_style, head, methods_section(report), visits_section(report), speeds_section(report),
        builds_section(report), walks_section(report));
}

} // namespace alhazen
