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
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/big_array.h"
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

/// What the kinds of film have in common: the picture's size and part, the sensor, and the picture itself.
class PictureFilm : public Film {
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
        const Vec3d rgb(measured(L, lambda));
        const std::size_t i = index(pixel);
        Sums& s = sums_[i];
        if (weight != 1 || s.is_weighted) add_weighted(i, rgb, static_cast<double>(weight));
        s.rgb += rgb;
        ++s.count;
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
    void set(Vec2i pixel, Vec3d measured) override { sums_[index(pixel)] = {measured, 1, false}; }
    Image image() const override;
    Image splat_image(std::size_t layer) const override;

  protected:
    template <class T>
    static void describe_picture(Fields<T>& f) {
        f.field("xresolution", &T::xresolution, "width of the whole picture")
            .in(1, Image::max_side)
            .unit("pixels");
        f.field("yresolution", &T::yresolution, "height of the whole picture")
            .in(1, Image::max_side)
            .unit("pixels");
        f.field("cropwindow", &T::cropwindow,
                "the part to render, as fractions of the picture: x from, x to, y from, y to; y counts down");
        f.field(
            "pixelbounds", &T::pixelbounds,
            "the part to render, in pixels: x from, x to, y from, y to (to is not included); cropwindow goes "
            "first");
        f.field("diagonal", &T::diagonal_mm, "of the film; matters to realistic lenses").above(0).unit("mm");
        f.field("filename", &T::file, "where the picture is written");
        f.field("savefp16", &T::savefp16, "OpenEXR files hold 16-bit instead of 32-bit numbers");
        f.field("maxcomponentvalue", &T::maxcomponentvalue,
                "samples whose largest component is above this are scaled down to it: against bright specks, "
                "at the "
                "price of energy")
            .above(0)
            .otherwise("no limit");
        f.field(
            "sensor", &T::sensor,
            "how colours are measured: by the CIE observer, or as the pixels of a camera see them and its "
            "maker would correct them; in RGB mode cameras differ from the observer by their white only");
        f.field("iso", &T::iso,
                "speed of the film; the picture is multiplied by exposure time times iso / 100")
            .above(0);
        f.field("whitebalance", &T::whitebalance,
                "colour temperature of light that shall look white; 0 for none, or 6500 for cameras")
            .at_least(0)
            .unit("K");
        f.field(
            "transfer", &T::transfer,
            "how 8-bit files store values: by the sRGB curve, or linear, as they are (like MATLAB's imshow)");
    }
    /// Of the picture.
    virtual int channels() const { return 3; }
    /// Exposure; scaled down to the limit, if there is one.
    Vec3 measured(Spectrum L, const Wavelengths& lambda) const {
        const Vec3 rgb = sensor_.to_sensor_rgb(L, lambda);
        const float largest = max_component(rgb);
        return largest > limit_ ? rgb * (limit_ / largest) : rgb;
    }
    /// Has a pixel's sums brought near, as they are going to be added to.
    void fetch(Vec2i pixel) const { __builtin_prefetch(sums_.data() + index(pixel), 1); }
    Vec3 output_color(Vec3 measured) const { return Vec3(output_from_sensor_ * Vec3d(measured)); }
    /// Of a pixel, in the rendered part's rows.
    std::size_t index(Vec2i p) const {
        return static_cast<std::size_t>(p.y - pixels_.lo.y) * static_cast<std::size_t>(pixels_.width()) +
               static_cast<std::size_t>(p.x - pixels_.lo.x);
    }
    std::size_t pixel_count() const {
        return static_cast<std::size_t>(pixels_.width()) * static_cast<std::size_t>(pixels_.height());
    }
    /// The picture with these channels after R, G and B, all zero.
    Image image_with(std::span<const std::string> more_channels) const;
    const RgbColorSpace& color_space() const { return *space_; }
    const Sensor& meter() const { return sensor_; }
    float limit() const { return limit_; }

  private:
    /// Of a pixel's samples.
    struct Sums {
        Vec3d rgb;
        std::uint32_t count = 0;
        bool is_weighted = false; ///< not all weights are 1
    };
    /// The same times the weights, for pixels that have others than 1; of other pixels they are not even
    /// touched, so that most pictures take half the memory.
    struct WeightedSums {
        Vec3d rgb;
        double weight = 0;
    };
    void add_weighted(std::size_t i, Vec3d rgb, double weight) {
        Sums& s = sums_[i];
        if (!s.is_weighted) weighted_[i] = {s.rgb, static_cast<double>(s.count)};
        s.is_weighted = true;
        weighted_[i].rgb += rgb * weight;
        weighted_[i].weight += weight;
    }
    /// Mean of a pixel's samples plus their covariance with their weights.
    Vec3d filtered(std::size_t i) const {
        const Sums& s = sums_[i];
        const auto count = static_cast<double>(s.count);
        if (!s.is_weighted) return s.rgb / count;
        return (s.rgb * (1 - weighted_[i].weight / count) + weighted_[i].rgb) / count;
    }

    Rect2i declared_pixels() const;
    bool check_counts(const Node& node, BuildContext& context) const;
    /// A picture of what the sensor measured at each pixel.
    template <class Measured>
    Image picture_of(Measured measured, std::span<const std::string> more_channels) const;

    Rect2i pixels_;
    Sensor sensor_;
    const RgbColorSpace* space_ = &srgb_space();
    Matrix3 output_from_sensor_;
    float limit_ = infinity;
    BigArray<Sums> sums_;
    BigArray<WeightedSums> weighted_;
    std::vector<Splats> splats_; ///< one a layer
    double splat_scale_ = 1;
};

} // namespace alhazen
