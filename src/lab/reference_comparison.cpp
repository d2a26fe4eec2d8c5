#include "lab/reference_comparison.h"

#include <algorithm>
#include <cmath>
#include <ctime>

#include <nlohmann/json.hpp>

#include "base/file.h"
#include "formats/format.h"
#include "image/codec.h"
#include "image/image_colors.h"
#include "image/metrics.h"
#include "image/resample.h"
#include "render/renderer.h"

namespace alhazen {

namespace {

double cpu_seconds() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Picture {
    Image image;
    double load = 0, render = 0; ///< processor seconds
    double wall = 0;
};

Picture render_once(const std::filesystem::path& file, const ReferenceComparisonOptions& options, int spp,
                    int seed) {
    RenderSettings settings;
    settings.spp = spp;
    settings.seed = static_cast<std::uint64_t>(seed);
    settings.integrator = options.integrator;
    Picture p;
    const double start = cpu_seconds();
    Messages messages;
    SceneDescription scene = read_scene(file, messages);
    if (options.change) options.change(scene);
    auto world = build_world(std::move(scene), settings, messages);
    p.load = cpu_seconds() - start;
    p.wall = render(*world, settings, {}).seconds;
    p.render = cpu_seconds() - start - p.load;
    p.image = world->film->image();
    return p;
}

Image mean_of(const std::vector<Image>& images, std::size_t first, std::size_t count) {
    Image mean = images[first];
    for (std::size_t v = 0; v < mean.values().size(); ++v) {
        double sum = 0;
        for (std::size_t i = first; i < first + count; ++i) sum += static_cast<double>(images[i].values()[v]);
        mean.values()[v] = static_cast<float>(sum / static_cast<double>(count));
    }
    return mean;
}

Vec3d mean_color(const Image& image) {
    Vec3d sum;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) sum += Vec3d(image.rgb(x, y));
    return sum / (static_cast<double>(image.width()) * image.height());
}

/// Mean square deviation of the images' values at a place, without bias.
double variance_of(const std::vector<Image>& images, int x, int y, int channel) {
    double sum = 0, squares = 0;
    for (const Image& image : images) {
        const auto v = static_cast<double>(image.rgb(x, y)[channel]);
        sum += v;
        squares += v * v;
    }
    const auto n = static_cast<double>(images.size());
    return std::max(0.0, (squares - sum * sum / n) / (n - 1));
}

/// relMSE of one image against what all of them tend to, the largest 0.1 % left out.
double noise_of(const std::vector<Image>& images, const Image& reference) {
    std::vector<double> terms;
    for (int y = 0; y < reference.height(); ++y)
        for (int x = 0; x < reference.width(); ++x)
            for (int c = 0; c < 3; ++c) {
                const auto r = static_cast<double>(reference.rgb(x, y)[c]);
                terms.push_back(variance_of(images, x, y, c) / (r * r + 0.01));
            }
    std::sort(terms.begin(), terms.end());
    const std::size_t kept = terms.size() - terms.size() / 1000;
    double sum = 0;
    for (std::size_t i = 0; i < kept; ++i) sum += terms[i];
    return sum / static_cast<double>(kept);
}

/// Pictures whose noise is spread over the image as the reference's is, and how much less the reference has.
struct NoiseModel {
    std::vector<Image> images;
    double ratio = 0; ///< of the reference's variance to theirs
};

// The reference's paths end by pbrt-v4's roulette; where ours go on, they have less noise and it has not.
NoiseModel model_noise(const ReferenceComparison& c, const std::filesystem::path& file,
                       ReferenceComparisonOptions options) {
    options.change = [inner = options.change](SceneDescription& scene) {
        if (inner) inner(scene);
        set_path_parameter(scene, make_float("roulettethreshold", 1));
    };
    NoiseModel model;
    for (int seed = 0; seed < c.seeds; ++seed)
        model.images.push_back(render_once(file, options, std::max(4, c.spp / 4), 2000 + seed).image);
    model.ratio = c.reference_noise / noise_of(model.images, c.reference);
    return model;
}

void compare_means(ReferenceComparison& c, const std::vector<Image>& images, double noise_ratio) {
    const Vec3d reference = mean_color(c.reference), ours = mean_color(c.ours);
    for (int channel = 0; channel < 3; ++channel) {
        double squares = 0;
        for (const Image& image : images) {
            const double d = mean_color(image)[channel] - ours[channel];
            squares += d * d;
        }
        const auto n = static_cast<double>(images.size());
        const double of_one = squares / (n - 1);
        const auto i = static_cast<std::size_t>(channel);
        c.mean_ratio[i] = ours[channel] / reference[channel];
        // The reference's mean is noisier than one of ours as its pixels are.
        c.mean_ratio_error[i] = std::sqrt(of_one / n + of_one * noise_ratio) / reference[channel];
    }
}

std::vector<Image> reduced_to(const std::vector<Image>& images, int width, int height) {
    std::vector<Image> reduced;
    reduced.reserve(images.size());
    for (const Image& image : images) reduced.push_back(resample_box(image, width, height));
    return reduced;
}

void compare_blocks(ReferenceComparison& c, const std::vector<Image>& images, const NoiseModel& model) {
    c.block = std::max(8, c.reference.width() / 24);
    const int width = std::max(1, c.reference.width() / c.block),
              height = std::max(1, c.reference.height() / c.block);
    const std::vector<Image> reduced = reduced_to(images, width, height),
                             modelled = reduced_to(model.images, width, height);
    const Image ours = resample_box(c.ours, width, height),
                reference = resample_box(c.reference, width, height);
    double squares = 0;
    int beyond = 0, count = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int channel = 0; channel < 3; ++channel) {
                const double of_ours =
                    variance_of(reduced, x, y, channel) / static_cast<double>(images.size());
                const double of_reference = variance_of(modelled, x, y, channel) * model.ratio;
                const double deviation = std::sqrt(of_ours + of_reference);
                const auto difference =
                    static_cast<double>(ours.rgb(x, y)[channel] - reference.rgb(x, y)[channel]);
                // Spectra fitted to colours and tabulated curves differ by a tenth of a percent, which shows
                // where there is no noise.
                const double rounding = 2e-3 * static_cast<double>(std::abs(reference.rgb(x, y)[channel]));
                const double z = difference / std::hypot(deviation, rounding + 1e-6);
                squares += z * z;
                beyond += std::abs(z) > 4;
                ++count;
            }
    c.mean_z2 = squares / count;
    c.beyond_four = static_cast<double>(beyond) / count;
}

} // namespace

void set_path_parameter(SceneDescription& scene, const Parameter& parameter) {
    const std::string& type = scene.integrator.type;
    // Scenes that name none are rendered by volpath.
    if (type == "path" || type == "volpath" || type.empty()) scene.integrator.set(parameter);
}

ReferenceComparison compare_with_reference(const std::filesystem::path& folder,
                                           const ReferenceComparisonOptions& options) {
    ReferenceComparison c;
    c.scene = folder.filename().string();
    c.reference = in_srgb(read_image(folder / "reference.exr"));
    c.reference_noise =
        nlohmann::json::parse(read_file(folder / "reference.json")).at("noise_relmse_trim999").get<double>();
    c.seeds = options.seeds;
    c.spp = options.spp;
    const std::filesystem::path file = folder / options.scene_file;
    if (c.spp == 0) {
        constexpr int trial = 8;
        const Picture p = render_once(file, options, trial, 1000);
        c.spp =
            std::clamp(static_cast<int>(options.seconds / c.seeds / std::max(p.wall / trial, 1e-4)), 4, 1024);
        c.spp = 1 << static_cast<int>(std::log2(c.spp)); // samplers like powers of two
    }
    std::vector<Image> images;
    for (int seed = 0; seed < c.seeds; ++seed) {
        Picture p = render_once(file, options, c.spp, seed + 1);
        if (seed == 0) {
            c.cpu_seconds = p.load + p.render;
            c.load_seconds = p.load;
        }
        images.push_back(std::move(p.image));
    }
    c.ours = mean_of(images, 0, images.size());
    c.noise = noise_of(images, c.reference);
    for (std::size_t together = 1; together <= images.size(); together *= 2) {
        double sum = 0;
        std::size_t count = 0;
        for (std::size_t first = 0; first + together <= images.size(); first += together, ++count)
            sum += relmse(mean_of(images, first, together), c.reference).value;
        c.errors.push_back({c.spp * static_cast<int>(together), sum / static_cast<double>(count)});
    }
    c.unexplained = relmse(c.ours, c.reference).value - c.noise / c.seeds - c.reference_noise;
    compare_means(c, images, c.reference_noise / c.noise);
    compare_blocks(c, images, model_noise(c, file, options));
    c.flip = flip(c.ours, c.reference).value;
    return c;
}

bool agrees(const ReferenceComparison& c) {
    for (std::size_t i = 0; i < 3; ++i)
        if (!(std::abs(c.mean_ratio[i] - 1) <= std::max(0.005, 3.5 * c.mean_ratio_error[i]))) return false;
    // Student's distribution with seven degrees of freedom: a mean square of 1.4, and 0.5 % beyond four.
    return c.mean_z2 < 2.5 && c.beyond_four < 0.02;
}

Image side_by_side(const ReferenceComparison& c) {
    const Image error = heat_map(flip(c.ours, c.reference).error);
    Image sheet = Image::rgb_image(3 * c.reference.width() + 8, c.reference.height());
    int left = 0;
    for (const Image* part : {&c.ours, &c.reference, &error}) {
        for (int y = 0; y < part->height(); ++y)
            for (int x = 0; x < part->width(); ++x) sheet.set_rgb(left + x, y, part->rgb(x, y));
        left += part->width() + 4;
    }
    return sheet;
}

} // namespace alhazen
