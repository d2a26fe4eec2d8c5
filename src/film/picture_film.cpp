#include "film/picture_film.h"

#include <cmath>
#include <stdexcept>

#include "base/threads.h"

namespace alhazen {

bool PictureFilm::check_counts(const Node& node, BuildContext& context) const {
    auto check = [&](std::string_view name, std::size_t count) {
        if (count == 0 || count == 4) return true;
        context.messages.add_error(node.place_of(name), "parameter \"" + std::string(name) + "\" has " +
                                                            std::to_string(count) +
                                                            " values, but must have 4");
        return false;
    };
    return check("cropwindow", cropwindow.size()) && check("pixelbounds", pixelbounds.size());
}

// A crop window's edges are rounded up, so that windows that touch share no pixel.
Rect2i PictureFilm::declared_pixels() const {
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

void PictureFilm::finish(const Node& node, BuildContext& context) {
    if (!check_counts(node, context)) return;
    pixels_ = declared_pixels();
    std::string_view crop = !cropwindow.empty() ? "cropwindow" : "pixelbounds";
    if (!cropwindow.empty() && !pixelbounds.empty())
        context.messages.add_warning(node.place_of("pixelbounds"),
                                     "pixelbounds has no effect, since cropwindow is given too");
    else if (!pixelbounds.empty() &&
             !(pixels_ == Rect2i{{pixelbounds[0], pixelbounds[2]}, {pixelbounds[1], pixelbounds[3]}}))
        context.messages.add_warning(node.place_of(crop), "pixelbounds reach beyond the picture and are cut");
    if (pixels_.empty()) {
        context.messages.add_error(node.place_of(crop),
                                   "the part of the picture to render holds no pixels; \"" +
                                       std::string(crop) + "\" must be x from, x to, y from, y to");
        return;
    }
    try {
        check_image_size(pixels_.width(), pixels_.height(), channels());
    } catch (const std::runtime_error& e) {
        context.messages.add_error(node.place_of("xresolution"), e.what());
        return;
    }
    if (node.color_space) space_ = node.color_space;
    const std::string name = sensor_names[static_cast<std::size_t>(sensor)];
    std::string error;
    auto found = Sensor::find({name, context.exposure_time, iso, whitebalance}, *space_, error);
    if (!found) {
        context.messages.add_error(node.place_of("sensor"), error);
        return;
    }
    sensor_ = *found;
    limit_ = maxcomponentvalue.value_or(infinity);
}

void PictureFilm::set_resolution(Vec2i resolution) {
    xresolution = std::clamp(resolution.x, 1, Image::max_side);
    yresolution = std::clamp(resolution.y, 1, Image::max_side);
    // Bounds in pixels were meant for another size.
    pixelbounds.clear();
    set_pixels(declared_pixels());
}

void PictureFilm::set_pixels(Rect2i pixels) {
    Vec2i lo{std::clamp(pixels.lo.x, 0, xresolution - 1), std::clamp(pixels.lo.y, 0, yresolution - 1)};
    // A part that is left empty by rounding or a smaller picture keeps one pixel.
    pixels_ = {
        lo, {std::clamp(pixels.hi.x, lo.x + 1, xresolution), std::clamp(pixels.hi.y, lo.y + 1, yresolution)}};
}

void PictureFilm::start(ColorMode mode) {
    check_image_size(pixels_.width(), pixels_.height(), channels());
    splats_.clear();
    output_from_sensor_ = sensor_.output_from_sensor(*space_, mode);
    const std::size_t count = pixel_count();
    if (sums_.size() != count) {
        sums_ = BigArray<Sums>(count);
        weighted_ = BigArray<WeightedSums>(count);
    }
    parallel_ranges(count, 16384, [this](std::size_t begin, std::size_t end) {
        std::fill(sums_.data() + begin, sums_.data() + end, Sums{});
    });
}

template <class Measured>
Image PictureFilm::picture_of(Measured measured, std::span<const std::string> more_channels) const {
    std::vector<std::string> channels{"R", "G", "B"};
    channels.insert(channels.end(), more_channels.begin(), more_channels.end());
    Image image(pixels_.width(), pixels_.height(), std::move(channels));
    image.info.origin = pixels_.lo;
    image.info.display_window = {{0, 0}, resolution()};
    if (space_ != &srgb_space()) image.info.metadata["color_space"] = space_->name;
    auto out = image.values();
    const auto stride = static_cast<std::size_t>(image.channels());
    for (std::size_t i = 0; i < sums_.size(); ++i) {
        const Vec3 rgb(output_from_sensor_ * measured(i));
        for (std::size_t c = 0; c < 3; ++c) out[stride * i + c] = rgb[static_cast<int>(c)];
    }
    return image;
}

Image PictureFilm::image_with(std::span<const std::string> more_channels) const {
    return picture_of(
        [this](std::size_t i) {
            Vec3d measured = sums_[i].count > 0 ? filtered(i) : Vec3d();
            if (!splats_.empty()) measured += splats_.front().sum(i) * splat_scale_;
            return measured;
        },
        more_channels);
}

Image PictureFilm::image() const {
    return image_with({});
}

Image PictureFilm::splat_image(std::size_t layer) const {
    return picture_of([&](std::size_t i) { return splats_[layer].sum(i) * splat_scale_; }, {});
}

} // namespace alhazen
