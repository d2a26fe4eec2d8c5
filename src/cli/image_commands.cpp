/// alhazen convert and alhazen diff: images between formats, and how far two are apart.
#include <cmath>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/commands.h"
#include "color/tone.h"
#include "image/codec.h"
#include "image/image_colors.h"
#include "image/metrics.h"

namespace alhazen {

namespace {

Image load(const std::string& file) {
    try {
        return read_image(file);
    } catch (const std::exception& e) {
        throw std::runtime_error(fmt::format("{}: {}", file, e.what()));
    }
}

void save(const std::string& file, const Image& image, const WriteOptions& options) {
    try {
        write_image(file, image, options);
    } catch (const std::exception& e) {
        throw std::runtime_error(fmt::format("{}: {}", file, e.what()));
    }
}

struct ConvertOptions {
    std::string in, out, layer, tonemap = "none", transfer = "srgb";
    float exposure = 0;
    int quality = 95;
    bool single = false;
};

// The three channels NAME.R, NAME.G, NAME.B or NAME.X, NAME.Y, NAME.Z, or the one channel NAME, as a picture.
Image layer_of(const Image& image, const ConvertOptions& options) {
    std::vector<std::string> channels;
    for (const char* letters : {"RGB", "XYZ"}) {
        channels.clear();
        for (const char* c = letters; *c; ++c)
            if (std::string name = options.layer + "." + *c; image.channel_index(name))
                channels.push_back(name);
        if (channels.size() == 3) break;
    }
    if (channels.size() != 3 && image.channel_index(options.layer)) channels.assign(3, options.layer);
    if (channels.size() != 3)
        throw std::runtime_error(fmt::format("{}: there is no layer \"{}\"; the channels are {}", options.in,
                                             options.layer, fmt::join(image.channel_names(), ", ")));
    Image layer = Image::rgb_image(image.width(), image.height());
    layer.info = image.info;
    for (std::size_t c = 0; c < 3; ++c) {
        const int from = *image.channel_index(channels[c]);
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x)
                layer.at(x, y, static_cast<int>(c)) = image.at(x, y, from);
    }
    return layer;
}

int run_convert(const ConvertOptions& options) {
    Image image = load(options.in);
    ToneCurve curve = *find_tone_curve(options.tonemap);
    if (!std::isfinite(options.exposure)) throw std::runtime_error("--exposure must be a finite number");
    if (!options.layer.empty()) image = layer_of(image, options);
    // Tone curves are made for sRGB's primaries.
    if (curve != ToneCurve::none) image = in_srgb(std::move(image));
    float gain = std::exp2(options.exposure);
    if (gain != 1 || curve != ToneCurve::none)
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x)
                image.set_rgb(x, y, tone_map(curve, image.rgb(x, y) * gain));
    WriteOptions write;
    write.jpeg_quality = options.quality;
    write.depth = options.single ? FloatDepth::single : FloatDepth::half;
    write.transfer = options.transfer == "linear" ? Transfer::linear : Transfer::srgb;
    save(options.out, image, write);
    return exit_ok;
}

struct DiffOptions {
    std::string a, b, metric = "flip", heat_map_file;
    double max = -1;
    bool has_max = false;
};

int run_diff(const DiffOptions& options) {
    Image a = in_srgb(load(options.a)), b = in_srgb(load(options.b));
    if (a.size() != b.size())
        throw std::runtime_error(fmt::format("the images differ in size: {} is {} x {}, {} is {} x {}",
                                             options.a, a.width(), a.height(), options.b, b.width(),
                                             b.height()));
    Metric chosen = *parse_metric(options.metric);
    double value = 0;
    for (const std::string& name : metric_names()) {
        Metric metric = *parse_metric(name);
        MetricResult result = compute_metric(metric, a, b);
        std::string note;
        if (metric == Metric::relmse)
            note = fmt::format("   (largest 0.1 % left out; with them {:.6g})", relmse(a, b).untrimmed);
        fmt::print("{:<7}{:.6g}{}\n", name, result.value, note);
        if (metric != chosen) continue;
        value = result.value;
        if (!options.heat_map_file.empty()) save(options.heat_map_file, heat_map(result.error), {});
    }
    if (!options.has_max) return exit_ok;
    // Written so that NaN counts as over the limit.
    bool within = larger_is_better(chosen) ? value >= options.max : value <= options.max;
    if (!within)
        fmt::print(stderr, "{} is {:.6g}, beyond the limit {:.6g}\n", options.metric, value, options.max);
    return within ? exit_ok : exit_over_limit;
}

} // namespace

void add_convert_command(CLI::App& app, Action& action) {
    auto options = std::make_shared<ConvertOptions>();
    CLI::App* command = app.add_subcommand("convert", "convert an image to another format");
    command->add_option("IN", options->in, "image to read")->required();
    command->add_option("OUT", options->out, "image to write; the suffix says the format")->required();
    command
        ->add_option("--layer", options->layer,
                     "of an image with more channels, those of this name: Albedo, N, P ...")
        ->type_name("NAME");
    command
        ->add_option("--exposure", options->exposure, "make it brighter by this many stops (factors of two)")
        ->check(CLI::Range(-100.0f, 100.0f))
        ->type_name("STOPS");
    command->add_option("--tonemap", options->tonemap, "curve from scene light to display light")
        ->check(CLI::IsMember(tone_curve_names()))
        ->type_name("none|srgb|aces|agx");
    command->add_option("--transfer", options->transfer, "how 8-bit files encode values")
        ->check(CLI::IsMember({"srgb", "linear"}))
        ->type_name("srgb|linear");
    command->add_option("--quality", options->quality, "of JPEG files")
        ->check(CLI::Range(1, 100))
        ->type_name("1-100");
    command->add_flag("--float", options->single, "EXR with 32 bits a channel instead of 16");
    command->callback([options, &action] { action = [options] { return run_convert(*options); }; });
}

void add_diff_command(CLI::App& app, Action& action) {
    auto options = std::make_shared<DiffOptions>();
    CLI::App* command = app.add_subcommand("diff", "compare an image with a reference by every metric");
    command->add_option("A", options->a, "image under test")->required();
    command->add_option("B", options->b, "reference")->required();
    std::vector<std::string> names(metric_names().begin(), metric_names().end());
    command->add_option("--metric", options->metric, "metric of --max and the heat map (default flip)")
        ->check(CLI::IsMember(names))
        ->type_name("mse|relmse|psnr|ssim|flip");
    auto* max = command->add_option("--max", options->max, "exit with 1 when the metric is worse than this")
                    ->type_name("X");
    command->add_option("-o,--output", options->heat_map_file, "write the error as a heat map")
        ->type_name("FILE");
    command->callback([options, max, &action] {
        options->has_max = max->count() > 0;
        action = [options] { return run_diff(*options); };
    });
}

} // namespace alhazen
