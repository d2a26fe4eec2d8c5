/// A picture of spectra: each pixel's radiance in ranges of wavelengths, as channels of an OpenEXR file
/// (layout of Fichet, Pacanowski and Wilkie 2021, "An OpenEXR Layout for Spectral Images"; parameters as in
/// pbrt-v4), beside red, green and blue.
///
/// A range holds the mean of its wavelengths' radiance. Each wavelength of a sample counts as much as it
/// stands for (one over its density), so lanes that dispersion has ended count nothing and the one that goes
/// on for all four.
#include <cmath>

#include <fmt/format.h>

#include "base/threads.h"
#include "film/picture_film.h"

namespace alhazen {
namespace {

struct SpectralFilm final : PictureFilm {
    int nbuckets = 16;
    float lambdamin = alhazen::lambda_min, lambdamax = alhazen::lambda_max;

    static void describe(Fields<SpectralFilm>& f) {
        f.about("A picture of spectra: red, green and blue, and radiance in ranges of wavelengths (channels "
                "S0.<middle>nm; OpenEXR files hold them, other files the colour). Needs spectral colours.");
        describe_picture(f);
        f.field("nbuckets", &SpectralFilm::nbuckets, "how many ranges of equal width").in(1, 256);
        f.field("lambdamin", &SpectralFilm::lambdamin,
                "shortest wavelength that is measured; light outside the range adds nothing to the colour "
                "either")
            .in(alhazen::lambda_min, alhazen::lambda_max)
            .unit("nm");
        f.field("lambdamax", &SpectralFilm::lambdamax, "longest wavelength that is measured")
            .in(alhazen::lambda_min, alhazen::lambda_max)
            .unit("nm");
        f.example("small", {make_integer("xresolution", 64), make_integer("yresolution", 64)});
        f.example("green",
                  {make_integer("nbuckets", 4), make_float("lambdamin", 500), make_float("lambdamax", 560)});
    }
    void finish(const Node& node, BuildContext& context) {
        PictureFilm::finish(node, context);
        const Place& place = node.place_of(node.find("lambdamin") ? "lambdamin" : "lambdamax");
        if (!(lambdamin < lambdamax))
            context.messages.add_error(place, fmt::format("lambdamin ({} nm) must be below lambdamax ({} nm)",
                                                          lambdamin, lambdamax));
        else if (nbuckets > 1 && channel_name(0) == channel_name(1))
            context.messages.add_error(
                place, "the ranges of wavelengths are so narrow that their names would be the "
                       "same; they must be at least 0.001 nm wide");
        if (context.color_mode == ColorMode::rgb)
            context.messages.add_error(
                node.place, "film \"spectral\" needs spectral colours, but the picture is made in RGB; "
                            "use --color spectral and an integrator that is not defined in RGB");
    }

    void start(ColorMode mode) override {
        PictureFilm::start(mode);
        const std::size_t count = pixel_count() * static_cast<std::size_t>(nbuckets);
        sums_ = BigArray<Sums>(count);
        parallel_ranges(count, 16384, [this](std::size_t begin, std::size_t end) {
            std::fill(sums_.data() + begin, sums_.data() + end, Sums{});
        });
    }
    Wavelengths sample_wavelengths(float u) const override {
        return Wavelengths::uniform(u, lambdamin, lambdamax);
    }
    void add(Vec2i pixel, Spectrum L, const Wavelengths& lambda, float weight) override {
        PictureFilm::add(pixel, L, lambda, weight);
        const float largest = max_component(meter().to_sensor_rgb(L, lambda));
        const float scale = meter().imaging_ratio() * (largest > limit() ? limit() / largest : 1);
        for (int i = 0; i < 4; ++i) {
            if (lambda.pdf[i] == 0) continue;
            Sums& s = sums_[index(pixel) * static_cast<std::size_t>(nbuckets) + range_of(lambda.lambda[i])];
            const double share = 1 / static_cast<double>(lambda.pdf[i]), w = static_cast<double>(weight);
            const double radiance = static_cast<double>(L[i] * scale);
            s.share += share;
            s.weight += share * w;
            s.radiance += share * radiance;
            s.weighted_radiance += share * w * radiance;
        }
    }
    bool takes_splats() const override { return false; }
    int channels() const override { return 3 + nbuckets; }
    Image image() const override;

  private:
    // As PictureFilm's, a mean plus a covariance with the filter's weights.
    struct Sums {
        double share = 0, weight = 0, radiance = 0, weighted_radiance = 0;

        double filtered() const {
            if (!(share > 0)) return 0;
            return (radiance * (1 - weight / share) + weighted_radiance) / share;
        }
    };
    std::size_t range_of(float lambda) const {
        const float at = (lambda - lambdamin) / (lambdamax - lambdamin) * static_cast<float>(nbuckets);
        return static_cast<std::size_t>(std::clamp(static_cast<int>(at), 0, nbuckets - 1));
    }
    /// "S0.550,000nm"
    std::string channel_name(int range) const {
        const float middle = lambdamin + (lambdamax - lambdamin) * (static_cast<float>(range) + 0.5f) /
                                             static_cast<float>(nbuckets);
        std::string text = fmt::format("S0.{:.3f}nm", middle);
        text[text.rfind('.')] = ',';
        return text;
    }

    BigArray<Sums> sums_;
};

Image SpectralFilm::image() const {
    std::vector<std::string> names;
    for (int i = 0; i < nbuckets; ++i) names.push_back(channel_name(i));
    Image image = image_with(names);
    image.info.metadata["spectralLayoutVersion"] = "1.0";
    image.info.metadata["emissiveUnits"] = "W.m^-2.sr^-1";
    auto out = image.values();
    const auto ranges = static_cast<std::size_t>(nbuckets);
    for (std::size_t i = 0; i < pixel_count(); ++i)
        for (std::size_t r = 0; r < ranges; ++r)
            out[i * (ranges + 3) + 3 + r] = static_cast<float>(sums_[i * ranges + r].filtered());
    return image;
}

} // namespace

Kind<Film> spectral_film() {
    return make_kind<Film, SpectralFilm>("spectral");
}

} // namespace alhazen
