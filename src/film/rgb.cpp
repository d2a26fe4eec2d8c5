/// The film of a digital camera: each pixel is the filtered mean of its samples as the sensor sees them,
/// turned into the colour space of the picture (Pharr et al. 2023, section 5.4).
///
/// Samples f come with the filter's weights w, drawn so that E[w] = 1 and the pixel is E[w f] (Ernst,
/// Stamminger and Greiner 2006). For filters with negative lobes w is +k or -k, and of a few samples neither
/// estimate at hand will do: sum(w f) / sum(w) divides by what may be 0, and sum(w f) / n makes even a
/// constant picture noisy. But E[w f] = E[f] + cov(w, f), so the pixel is taken to be the plain mean of the
/// samples plus their covariance with their weights: nothing to divide by, exact where all samples agree, and
/// consistent. (In other words, the plain mean is a control variate. Dividing the covariance by n, not n - 1,
/// leaves a bias of (E[f] - E[w f]) / n, a little less sharpening, and has less variance.) With weights that
/// are all 1 it is the plain mean.
#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

#include "base/big_array.h"
#include "base/threads.h"
#include "color/color_space.h"
#include "color/sensor.h"
#include "film/film.h"
#include "film/splats.h"

namespace alhazen {

enum class TransferCurve { srgb, linear };
template <>
struct EnumNames<TransferCurve> {
    static constexpr std::array names{"srgb", "linear"};
};

/// Counts sensor_names.
enum class SensorChoice {};
template <>
struct EnumNames<SensorChoice> {
    static constexpr auto names = sensor_names;
};

namespace {

Place place_of(const Node& node, std::string_view parameter) {
    const Parameter* p = node.find(parameter);
    return p ? p->place : node.place;
}

class RgbFilm final : public Film {
  public:
    int xresolution = 1280, yresolution = 720;
    std::vector<float> cropwindow;
    std::vector<int> pixelbounds;
    float diagonal_mm = 35;
    std::string file;
    bool savefp16 = true;
    std::optional<float> maxcomponentvalue;
    SensorChoice sensor{}; ///< the CIE observer
    float iso = 100;
    float whitebalance = 0;
    TransferCurve transfer = TransferCurve::srgb;

    static void describe(Fields<RgbFilm>& f);
    void finish(const Node& node, BuildContext& context);

    Vec2i resolution() const override { return {xresolution, yresolution}; }
    Rect2i pixels() const override { return pixels_; }
    void set_resolution(Vec2i resolution) override;
    void set_pixels(Rect2i pixels) override;
    std::string filename() const override { return file; }
    float diagonal() const override { return diagonal_mm * 1e-3f; }
    bool half_float() const override { return savefp16; }
    bool linear_transfer() const override { return transfer == TransferCurve::linear; }

    void start(ColorMode mode) override;
    void add(Vec2i pixel, Spectrum L, const Wavelengths& lambda, float weight) override {
        const Vec3 rgb = measured(L, lambda);
        Sums& s = sums_[index(pixel)];
        const double w = static_cast<double>(weight);
        s.rgb += Vec3d(rgb);
        s.weighted_rgb += Vec3d(rgb) * w;
        s.weight += w;
        s.count += 1;
    }
    bool takes_splats() const override { return true; }
    void start_splats(const Filter& filter, std::size_t more_layers) override {
        splats_.clear();
        for (std::size_t i = 0; i <= more_layers; ++i) splats_.emplace_back(pixels_, filter);
        splat_scale_ = 1;
    }
    void add_splat(Vec2 position, Spectrum L, const Wavelengths& lambda, std::size_t layer) override {
        splats_[layer].add(position, measured(L, lambda));
    }
    bool splat_reaches(Vec2 position) const override {
        return !splats_.empty() && splats_.front().reaches(position);
    }
    void set_splat_scale(double scale) override { splat_scale_ = scale; }
    Vec3 measure(Spectrum L, const Wavelengths& lambda) const override {
        return sensor_.to_sensor_rgb(L, lambda);
    }
    void set(Vec2i pixel, Vec3d measured) override { sums_[index(pixel)] = {measured, measured, 1, 1}; }
    Image image() const override;
    Image splat_image(std::size_t layer) const override;

  private:
    Vec3 measured(Spectrum L, const Wavelengths& lambda) const {
        const Vec3 rgb = sensor_.to_sensor_rgb(L, lambda);
        const float largest = max_component(rgb);
        return largest > limit_ ? rgb * (limit_ / largest) : rgb;
    }
    // One cache line.
    struct Sums {
        Vec3d rgb, weighted_rgb;
        double weight = 0, count = 0;

        // Mean of the samples plus their covariance with their weights.
        Vec3d filtered() const { return (rgb * (1 - weight / count) + weighted_rgb) / count; }
    };

    std::size_t index(Vec2i p) const {
        return static_cast<std::size_t>(p.y - pixels_.lo.y) * static_cast<std::size_t>(pixels_.width()) +
               static_cast<std::size_t>(p.x - pixels_.lo.x);
    }
    Rect2i declared_pixels() const;
    bool check_counts(const Node& node, BuildContext& context) const;

    Rect2i pixels_;
    Sensor sensor_;
    const RgbColorSpace* space_ = &srgb_space();
    Matrix3 output_from_sensor_;
    float limit_ = infinity;
    BigArray<Sums> sums_;
    /// A picture of what the sensor measured at each pixel.
    template <class Measured>
    Image picture_of(Measured measured) const;

    std::vector<Splats> splats_; ///< one a layer
    double splat_scale_ = 1;
};

void RgbFilm::describe(Fields<RgbFilm>& f) {
    using F = RgbFilm;
    f.about("A digital camera's picture: red, green and blue for each pixel.");
    f.field("xresolution", &F::xresolution, "width of the whole picture")
        .in(1, Image::max_side)
        .unit("pixels");
    f.field("yresolution", &F::yresolution, "height of the whole picture")
        .in(1, Image::max_side)
        .unit("pixels");
    f.field("cropwindow", &F::cropwindow,
            "the part to render, as fractions of the picture: x from, x to, y from, y to; y counts down");
    f.field("pixelbounds", &F::pixelbounds,
            "the part to render, in pixels: x from, x to, y from, y to (to is not included); cropwindow goes "
            "first");
    f.field("diagonal", &F::diagonal_mm, "of the film; matters to realistic lenses").above(0).unit("mm");
    f.field("filename", &F::file, "where the picture is written");
    f.field("savefp16", &F::savefp16, "OpenEXR files hold 16-bit instead of 32-bit numbers");
    f.field(
         "maxcomponentvalue", &F::maxcomponentvalue,
         "samples whose largest component is above this are scaled down to it: against bright specks, at the "
         "price of energy")
        .above(0)
        .otherwise("no limit");
    f.field("sensor", &F::sensor,
            "how colours are measured: by the CIE observer, or as the pixels of a camera see them and its "
            "maker would correct them; in RGB mode cameras differ from the observer by their white only");
    f.field("iso", &F::iso, "speed of the film; the picture is multiplied by exposure time times iso / 100")
        .above(0);
    f.field("whitebalance", &F::whitebalance,
            "colour temperature of light that shall look white; 0 for none, or 6500 for cameras")
        .at_least(0)
        .unit("K");
    f.field("transfer", &F::transfer,
            "how 8-bit files store values: by the sRGB curve, or linear, as they are (like MATLAB's imshow)");
    f.example("square", {make_integer("xresolution", 64), make_integer("yresolution", 64)});
    f.example("middle",
              {make_array("cropwindow", ValueType::real, std::vector<float>{.25f, .75f, .25f, .75f})});
}

bool RgbFilm::check_counts(const Node& node, BuildContext& context) const {
    auto check = [&](std::string_view name, std::size_t count) {
        if (count == 0 || count == 4) return true;
        context.messages.add_error(place_of(node, name), "parameter \"" + std::string(name) + "\" has " +
                                                             std::to_string(count) +
                                                             " values, but must have 4");
        return false;
    };
    return check("cropwindow", cropwindow.size()) && check("pixelbounds", pixelbounds.size());
}

// A crop window's edges are rounded up, so that windows that touch share no pixel.
Rect2i RgbFilm::declared_pixels() const {
    if (!cropwindow.empty()) {
        auto edge = [&](float a, int size) {
            return static_cast<int>(std::ceil(static_cast<float>(size) * std::clamp(a, 0.0f, 1.0f)));
        };
        auto [x0, x1] = std::minmax(cropwindow[0], cropwindow[1]);
        auto [y0, y1] = std::minmax(cropwindow[2], cropwindow[3]);
        return {{edge(x0, xresolution), edge(y0, yresolution)},
                {edge(x1, xresolution), edge(y1, yresolution)}};
    }
    if (!pixelbounds.empty()) {
        auto x = [&](int v) { return std::clamp(v, 0, xresolution); };
        auto y = [&](int v) { return std::clamp(v, 0, yresolution); };
        return {{x(pixelbounds[0]), y(pixelbounds[2])}, {x(pixelbounds[1]), y(pixelbounds[3])}};
    }
    return {{0, 0}, {xresolution, yresolution}};
}

void RgbFilm::finish(const Node& node, BuildContext& context) {
    if (!check_counts(node, context)) return;
    pixels_ = declared_pixels();
    std::string_view crop = !cropwindow.empty() ? "cropwindow" : "pixelbounds";
    if (!cropwindow.empty() && !pixelbounds.empty())
        context.messages.add_warning(place_of(node, "pixelbounds"),
                                     "pixelbounds has no effect, since cropwindow is given too");
    else if (!pixelbounds.empty() &&
             !(pixels_ == Rect2i{{pixelbounds[0], pixelbounds[2]}, {pixelbounds[1], pixelbounds[3]}}))
        context.messages.add_warning(place_of(node, crop),
                                     "pixelbounds reach beyond the picture and are cut");
    if (pixels_.empty()) {
        context.messages.add_error(place_of(node, crop),
                                   "the part of the picture to render holds no pixels; \"" +
                                       std::string(crop) + "\" must be x from, x to, y from, y to");
        return;
    }
    try {
        check_image_size(pixels_.width(), pixels_.height(), 3);
    } catch (const std::runtime_error& e) {
        context.messages.add_error(place_of(node, "xresolution"), e.what());
        return;
    }
    // A colour space in effect at the film marks all of its parameters; those added in code stay at the
    // default.
    for (const Parameter& p : node.parameters)
        if (const RgbColorSpace* space = find_color_space(p.color_space); space && space != &srgb_space())
            space_ = space;
    const std::string name = sensor_names[static_cast<std::size_t>(sensor)];
    std::string error;
    auto found = Sensor::find({name, context.exposure_time, iso, whitebalance}, *space_, error);
    if (!found) {
        context.messages.add_error(place_of(node, "sensor"), error);
        return;
    }
    sensor_ = *found;
    limit_ = maxcomponentvalue.value_or(infinity);
}

void RgbFilm::set_resolution(Vec2i resolution) {
    xresolution = std::clamp(resolution.x, 1, Image::max_side);
    yresolution = std::clamp(resolution.y, 1, Image::max_side);
    // Bounds in pixels were meant for another size.
    pixelbounds.clear();
    set_pixels(declared_pixels());
}

void RgbFilm::set_pixels(Rect2i pixels) {
    Vec2i lo{std::clamp(pixels.lo.x, 0, xresolution - 1), std::clamp(pixels.lo.y, 0, yresolution - 1)};
    // A part that is left empty by rounding or a smaller picture keeps one pixel.
    pixels_ = {
        lo, {std::clamp(pixels.hi.x, lo.x + 1, xresolution), std::clamp(pixels.hi.y, lo.y + 1, yresolution)}};
}

void RgbFilm::start(ColorMode mode) {
    check_image_size(pixels_.width(), pixels_.height(), 3);
    splats_.clear();
    output_from_sensor_ = sensor_.output_from_sensor(*space_, mode);
    const std::size_t count =
        static_cast<std::size_t>(pixels_.width()) * static_cast<std::size_t>(pixels_.height());
    if (sums_.size() != count) sums_ = BigArray<Sums>(count);
    parallel_ranges(count, 16384, [this](std::size_t begin, std::size_t end) {
        std::fill(sums_.data() + begin, sums_.data() + end, Sums{});
    });
}

template <class Measured>
Image RgbFilm::picture_of(Measured measured) const {
    Image image = Image::rgb_image(pixels_.width(), pixels_.height());
    image.info.origin = pixels_.lo;
    image.info.display_window = {{0, 0}, resolution()};
    if (space_ != &srgb_space()) image.info.metadata["color_space"] = space_->name;
    auto out = image.values();
    for (std::size_t i = 0; i < sums_.size(); ++i) {
        const Vec3 rgb(output_from_sensor_ * measured(i));
        for (std::size_t c = 0; c < 3; ++c) out[3 * i + c] = rgb[static_cast<int>(c)];
    }
    return image;
}

Image RgbFilm::image() const {
    return picture_of([this](std::size_t i) {
        Vec3d measured = sums_[i].count > 0 ? sums_[i].filtered() : Vec3d();
        if (!splats_.empty()) measured += splats_.front().sum(i) * splat_scale_;
        return measured;
    });
}

Image RgbFilm::splat_image(std::size_t layer) const {
    return picture_of([&](std::size_t i) { return splats_[layer].sum(i) * splat_scale_; });
}

} // namespace

Kind<Film> rgb_film() {
    return make_kind<Film, RgbFilm>("rgb");
}

} // namespace alhazen
