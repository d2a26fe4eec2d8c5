/// The files that the laboratory writes.
#include <regex>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "lab/bar_plot.h"
#include "lab/report.h"
#include "lab/timing.h"

namespace alhazen {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

LabReport small_report() {
    LabReport report;
    report.scene = "a<b & \"c\".pbrt";
    report.triangles = 12;
    report.why_alone = "there is none";
    report.view = Image::grey_image(8, 8);
    for (const char* walk : {"stack", "cwbvh"}) {
        BuildRecord build;
        build.choice.builder = "lbvh+reinsertion";
        build.choice.walk = walk;
        build.build_s = 0.25;
        build.sah_cost = 17.5;
        report.builds.push_back(build);
        report.visits.push_back(Image::grey_image(8, 8));
    }
    for (std::size_t build : {0u, 1u})
        for (TraceMode mode : {TraceMode::single, TraceMode::batch}) {
            WalkRecord w;
            w.build = build;
            w.rays = RayKind::shadow;
            w.query = Query::any;
            w.mode = mode;
            w.mrays_per_s = 3;
            w.nodes_per_ray = 11.5;
            report.walks.push_back(w);
        }
    return report;
}

TEST(JsonReport, HasAllKeysAndNullWithoutPeer) {
    auto json = nlohmann::json::parse(to_json(small_report()));
    ASSERT_EQ(json.size(), 4u);
    for (const auto& record : json) {
        for (const char* key :
             {"scene",    "builder",           "walk",           "rays",      "query",
              "mode",     "mrays_per_s",       "embree_ratio",   "build_s",   "bytes_per_triangle",
              "sah_cost", "nodes_per_ray",     "leaves_per_ray", "spread",    "nodes",
              "depth",    "end_point_overlap", "max_stack",      "agreement", "threads"})
            EXPECT_TRUE(record.contains(key)) << key;
        EXPECT_TRUE(record["embree_ratio"].is_null());
        EXPECT_TRUE(record["agreement"].is_null());
    }
    EXPECT_EQ(json[0]["scene"], "a<b & \"c\".pbrt");
    EXPECT_EQ(json[3]["walk"], "cwbvh");
    EXPECT_EQ(json[3]["mode"], "batch");
    EXPECT_EQ(json[3]["rays"], "shadow");
    EXPECT_EQ(json[3]["query"], "any");
    EXPECT_EQ(json[0]["sah_cost"], 17.5);
}

TEST(JsonReport, HasThePeersNumbers) {
    LabReport report = small_report();
    report.walks[0].peer_ratio = 1.5;
    report.walks[0].agreement = Agreement{0.75, 0.25};
    auto json = nlohmann::json::parse(to_json(report));
    EXPECT_EQ(json[0]["embree_ratio"], 1.5);
    EXPECT_EQ(json[0]["agreement"], 0.75);
    EXPECT_EQ(json[0]["ties"], 0.25);
}

std::size_t count_of(const std::string& text, const std::string& what) {
    std::size_t n = 0;
    for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
    return n;
}

TEST(HtmlReport, IsOneFileThatNeedsNothingElse) {
    std::string html = to_html(small_report());
    EXPECT_THAT(html, Not(HasSubstr("http")));
    EXPECT_THAT(html, Not(HasSubstr("<script")));
    EXPECT_THAT(html, Not(HasSubstr("<link")));
    EXPECT_THAT(html, Not(HasSubstr("url(//")));
    // The view, and one for each structure.
    EXPECT_EQ(count_of(html, "<img"), 3u);
    EXPECT_EQ(count_of(html, "src=\"data:image/png;base64,iVBORw0KGgo"), 3u);
    EXPECT_EQ(count_of(html, "<svg"), count_of(html, "</svg>"));
    // A plot of the shadow rays, one of times, one of memory, and the scale of colours.
    EXPECT_EQ(count_of(html, "<svg"), 4u);
    for (const char* tag : {"section", "figure", "table", "dl", "p", "h2"})
        EXPECT_EQ(count_of(html, std::string("<") + tag + ">"), count_of(html, std::string("</") + tag + ">"))
            << tag;
    EXPECT_THAT(html, HasSubstr("prefers-color-scheme: dark"));
}

TEST(HtmlReport, TellsWhatWasComparedAndEscapesNames) {
    std::string html = to_html(small_report());
    for (const char* text : {"lbvh+reinsertion/stack", "lbvh+reinsertion/cwbvh", "reinsertion).",
                             "there is none", "a&lt;b &amp; &quot;c&quot;.pbrt", "17.50"})
        EXPECT_THAT(html, HasSubstr(text));
    EXPECT_THAT(html, Not(HasSubstr("a<b")));
}

TEST(Explanations, AreMoreThanTheOneLineOfTheList) {
    for (const AccelBuilder& b : accel_builders()) EXPECT_GT(explain_builder(b.name).size(), 150u) << b.name;
    for (const AccelWalk& w : accel_walks()) EXPECT_GT(explain_walk(w.name).size(), 150u) << w.name;
    EXPECT_EQ(explain_walk("none"), "");
}

TEST(BarPlot, BarsAreAsLongAsTheirValues) {
    BarPlot plot;
    plot.unit = "a < b";
    plot.rows = {{"one", {{1, "batch", "tip"}}}, {"two", {{2, "single", "tip"}}}};
    plot.marks = {{3, "mark"}};
    std::string svg = plot.svg();
    std::regex bar("<rect class=\"([a-z]+)\"[^>]* width=\"([0-9.]+)\"");
    std::vector<double> widths;
    for (std::sregex_iterator it(svg.begin(), svg.end(), bar), end; it != end; ++it)
        widths.push_back(std::stod((*it)[2]));
    ASSERT_EQ(widths.size(), 2u);
    EXPECT_NEAR(widths[1], 2 * widths[0], 0.2);
    EXPECT_THAT(svg, HasSubstr("a &lt; b"));
    EXPECT_THAT(svg, HasSubstr(">0</text>"));
    EXPECT_THAT(svg, HasSubstr(">3</text>"));
    EXPECT_THAT(BarPlot{}.svg(), HasSubstr("</svg>"));
}

TEST(BarPlot, AFileOfItsOwnHasStyleAndKeys) {
    BarPlot plot;
    plot.title = "a < b";
    plot.rows.push_back({"row", {{2, "first", "tip"}}});
    plot.keys.push_back({"first", "what it is"});
    const std::string file = plot.svg_file();
    EXPECT_THAT(file, HasSubstr("xmlns=\"http://www.w3.org/2000/svg\""));
    EXPECT_THAT(file, HasSubstr("<style>"));
    EXPECT_THAT(file, HasSubstr("what it is"));
    EXPECT_THAT(file, HasSubstr("a &lt; b"));
    EXPECT_THAT(file, HasSubstr("class=\"first\""));
    EXPECT_THAT(plot.svg(), Not(HasSubstr("<style>")));
}

TEST(Duration, HasAReadableUnit) {
    EXPECT_EQ(timing_text(1.234), "1.23 s");
    EXPECT_EQ(timing_text(0.0456), "45.6 ms");
    EXPECT_EQ(timing_text(1.2e-5), "12.0 us");
    EXPECT_EQ(timing_text(0.5), "500 ms");
}

} // namespace
} // namespace alhazen
