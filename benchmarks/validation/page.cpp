#include "benchmarks/validation/page.h"

#include <cmath>

#include <fmt/format.h>

#include "base/file.h"
#include "benchmarks/page_marks.h"
#include "benchmarks/validation/facts.h"
#include "benchmarks/validation/record.h"
#include "image/codec.h"

namespace alhazen::bench {

namespace {

/// Processor seconds times error above the reference's noise: how much work a given quality takes.
double work(double cpu_seconds, double relmse, double reference_noise) {
    return cpu_seconds * std::max(relmse - reference_noise, 1e-9);
}

/// How many times as long the other renderer takes to a picture as good.
double speed(const SceneFacts& facts, const Json& r) {
    const double noise = r.at("reference_noise").get<double>();
    const double ours =
        work(r.at("cpu_seconds").get<double>(), r.at("errors").front().at("relmse").get<double>(), noise);
    return work(facts.many.cpu_seconds, facts.many.relmse, noise) / ours;
}

std::string table_row(const SceneFacts& facts, const Json& r) {
    const auto ratios = r.at("mean_ratio").get<std::array<double, 3>>();
    return fmt::format(
        "| {} | {:.3f} {:.3f} {:.3f} (± {:.3f}) | {} × {} | {:.4f} | {:.4f} | {:+.4f} | {:.2f} | {:.3f} | {} "
        "| {:.1f} |\n",
        facts.name, ratios[0], ratios[1], ratios[2], r.at("mean_ratio_error").at(1).get<double>(),
        r.at("seeds").get<int>(), r.at("spp").get<int>(), r.at("errors").back().at("relmse").get<double>(),
        r.at("reference_noise").get<double>(), r.at("unexplained").get<double>(),
        r.at("mean_z2").get<double>(), r.at("flip").get<double>(),
        verdict_on(facts, r.at("agrees").get<bool>(), ratios, r.at("mean_z2").get<double>()),
        speed(facts, r));
}

} // namespace

void write_validation_page(const std::filesystem::path& records, const std::filesystem::path& page) {
    const std::filesystem::path images = page.parent_path() / "images" / "validation";
    std::filesystem::create_directories(images);
    std::string figures = "\n| scene | mean over the reference's: red, green, blue (standard error of green) "
                          "| samples a pixel | relMSE of all | the reference's noise | unexplained | z² | "
                          "FLIP | verdict | times pbrt-v4 at equal error |\n"
                          "|---|---|---|---|---|---|---|---|---|---|\n";
    std::string pictures;
    double logs = 0;
    int count = 0;
    for (const SceneFacts& facts : validation_scenes()) {
        const std::filesystem::path record = records / (facts.name + ".json");
        if (!std::filesystem::exists(record)) continue;
        const Json r = Json::parse(read_file(record));
        figures += table_row(facts, r);
        logs += std::log(speed(facts, r));
        ++count;
        WriteOptions options;
        options.jpeg_quality = 88;
        write_image(images / (facts.name + ".jpg"), read_image(records / (facts.name + ".png")), options);
        pictures += fmt::format(
            "\n{}\n\n![{}: ours, the reference, and where they differ](images/validation/{}.jpg)\n",
            facts.name, facts.name, facts.name);
    }
    if (count > 0)
        figures += fmt::format("\nGeometric mean of the last column: {:.1f}.\n", std::exp(logs / count));
    put_between_marks(page, "figures", figures + pictures + "\n");
}

} // namespace alhazen::bench
