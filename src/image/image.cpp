#include "image/image.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "color/tone.h"

namespace alhazen {

void check_image_size(long long width, long long height, long long channels) {
    if (width < 1 || height < 1)
        throw std::runtime_error(
            fmt::format("image of {} x {} pixels; both sides must be at least 1", width, height));
    if (width > Image::max_side || height > Image::max_side)
        throw std::runtime_error(
            fmt::format("image of {} x {} pixels; sides may be at most {}", width, height, Image::max_side));
    if (channels < 1) throw std::runtime_error("image without channels");
    // The product of the sides is at most 2^32 here.
    if (static_cast<unsigned long long>(channels) >
        Image::max_values /
            (static_cast<unsigned long long>(width) * static_cast<unsigned long long>(height)))
        throw std::runtime_error(
            fmt::format("image of {} x {} pixels with {} channels; at most {} values are allowed", width,
                        height, channels, Image::max_values));
}

Image::Image(int width, int height, std::vector<std::string> channel_names)
    : names_(std::move(channel_names)) {
    check_image_size(width, height, static_cast<long long>(names_.size()));
    width_ = width;
    height_ = height;
    values_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * names_.size());
    // Plain R, G, B first, then the first layer that has the three.
    std::vector<std::string> layers{""};
    for (const std::string& name : names_)
        if (name.ends_with(".R")) layers.push_back(name.substr(0, name.size() - 1));
    for (const std::string& layer : layers) {
        auto r = channel_index(layer + "R"), g = channel_index(layer + "G"), b = channel_index(layer + "B");
        if (!r || !g || !b) continue;
        rgb_[0] = static_cast<std::size_t>(*r);
        rgb_[1] = static_cast<std::size_t>(*g);
        rgb_[2] = static_cast<std::size_t>(*b);
        break;
    }
}

std::optional<int> Image::channel_index(std::string_view name) const {
    auto found = std::find(names_.begin(), names_.end(), name);
    if (found == names_.end()) return std::nullopt;
    return static_cast<int>(found - names_.begin());
}

void Image::set_rgb(int x, int y, Vec3 color) {
    auto p = pixel(x, y);
    if (!has_rgb()) {
        p[0] = luminance(color);
        return;
    }
    for (int i = 0; i < 3; ++i) p[rgb_[i]] = color[i];
}

Image Image::crop(Rect2i r) const {
    if (r.empty() || r.lo.x < 0 || r.lo.y < 0 || r.hi.x > width_ || r.hi.y > height_)
        throw std::runtime_error(fmt::format("crop {},{} to {},{} is not inside the image of {} x {} pixels",
                                             r.lo.x, r.lo.y, r.hi.x, r.hi.y, width_, height_));
    Image out(r.width(), r.height(), names_);
    for (int y = 0; y < out.height(); ++y) {
        auto first = values_.begin() + static_cast<std::ptrdiff_t>(index(r.lo.x, r.lo.y + y));
        auto count = static_cast<std::ptrdiff_t>(static_cast<std::size_t>(r.width()) * names_.size());
        std::copy(first, first + count, out.values_.begin() + static_cast<std::ptrdiff_t>(out.index(0, y)));
    }
    out.info = info;
    if (info.display_window.empty()) out.info.display_window = {info.origin, info.origin + size()};
    out.info.origin = info.origin + r.lo;
    return out;
}

Image Image::select(std::span<const std::string> names) const {
    std::vector<std::size_t> from;
    for (const std::string& name : names) {
        auto c = channel_index(name);
        if (!c)
            throw std::runtime_error(
                fmt::format("no channel \"{}\" in the image; it has {}", name, fmt::join(names_, ", ")));
        from.push_back(static_cast<std::size_t>(*c));
    }
    Image out(width_, height_, {names.begin(), names.end()});
    out.info = info;
    for (std::size_t i = 0, o = 0; i < values_.size(); i += names_.size())
        for (std::size_t c : from) out.values_[o++] = values_[i + c];
    return out;
}

Image Image::to_rgb() const {
    Image out = rgb_image(width_, height_);
    out.info = info;
    for (std::size_t i = 0, o = 0; i < values_.size(); i += names_.size())
        for (std::size_t c : rgb_) out.values_[o++] = values_[i + c];
    return out;
}

} // namespace alhazen
