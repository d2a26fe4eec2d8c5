#include "benchmarks/validation/page.h"

#include <fmt/format.h>

#include "base/file.h"
#include "benchmarks/validation/facts.h"
#include "benchmarks/validation/record.h"
#include "image/codec.h"

namespace alhazen::bench {

namespace {

constexpr std::string_view begin_mark = "<!-- figures -->", end_mark = "<!-- end of figures -->";

/// Processor seconds times error above the reference's noise: how much work a given quality takes.
double work(double cpu_seconds, double relmse, double reference_noise) {
    return cpu_seconds * std::max(relmse - reference_noise, 1e-9);
}

/// What the last column but one says.
std::string_view verdict_on(const SceneFacts& facts, bool agrees) {
    if (agrees) return "yes";
    return facts.known_difference > 0 ? "differs by design" : "no";
}

std::string table_row(const SceneFacts& facts, const Json& r) {
    const auto ratios = r.at("mean_ratio").get<std::array<double, 3>>();
    const double noise = r.at("reference_noise").get<double>();
    const Json& first = r.at("errors").front();
    const double ours = work(r.at("cpu_seconds").get<double>(), first.at("relmse").get<double>(), noise);
    const double theirs = work(facts.many.cpu_seconds, facts.many.relmse, noise);
    return fmt::format(
        "| {} | {:.3f} {:.3f} {:.3f} (± {:.3f}) | {} × {} | {:.4f} | {:.4f} | {:+.4f} | {:.2f} | {:.3f} | {} "
        "| {:.1f} |\n",
        facts.name, ratios[0], ratios[1], ratios[2], r.at("mean_ratio_error").at(1).get<double>(),
        r.at("seeds").get<int>(), r.at("spp").get<int>(), r.at("errors").back().at("relmse").get<double>(),
        noise, r.at("unexplained").get<double>(), r.at("mean_z2").get<double>(), r.at("flip").get<double>(),
        verdict_on(facts, r.at("agrees").get<bool>()), theirs / ours);
}

} // namespace

void write_validation_page(const std::filesystem::path& records, const std::filesystem::path& page) {
    const std::string text = read_file(page);
    const std::size_t begin = text.find(begin_mark), end = text.find(end_mark);
    if (begin == std::string::npos || end == std::string::npos || end < begin)
        throw std::runtime_error(
            fmt::format("{}: the page has no marks {} and {}", page.string(), begin_mark, end_mark));
    const std::filesystem::path images = page.parent_path() / "images" / "validation";
    std::filesystem::create_directories(images);
    std::string figures = "\n| scene | mean over the reference's: red, green, blue (standard error of green) "
                          "| samples a pixel | relMSE of all | the reference's noise | unexplained | z² | "
                          "FLIP | agrees | times pbrt-v4 at equal error |\n"
                          "|---|---|---|---|---|---|---|---|---|---|\n";
    std::string pictures;
    for (const SceneFacts& facts : validation_scenes()) {
        const std::filesystem::path record = records / (facts.name + ".json");
        if (!std::filesystem::exists(record)) continue;
        figures += table_row(facts, Json::parse(read_file(record)));
        WriteOptions options;
        options.jpeg_quality = 88;
        write_image(images / (facts.name + ".jpg"), read_image(records / (facts.name + ".png")), options);
        pictures += fmt::format(
            "\n{}\n\n![{}: ours, the reference, and where they differ](images/validation/{}.jpg)\n",
            facts.name, facts.name, facts.name);
    }
    write_file(page, text.substr(0, begin + begin_mark.size()) + "\n" + figures + pictures + "\n" +
                         text.substr(end));
}

} // namespace alhazen::bench
