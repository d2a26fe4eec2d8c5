/// Images in memory: a rectangle of pixels, each with the same named float channels. Picture a sheet of paper
/// with its corner (0, 0) at the upper left; rows follow each other in memory, and a pixel's channels stand
/// together.
#pragma once

#include <cassert>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/bounds.h"
#include "image/encoding.h"

namespace alhazen {

/// What a file says besides its pixels.
struct ImageInfo {
    /// Where the pixel (0, 0) lies in the full picture (EXR: the data window's corner).
    Vec2i origin;
    /// The full picture, of which the pixels may be a part; empty: the pixels are all of it.
    Rect2i display_window;
    /// Names and values as the file has them (EXR string attributes, PNG text).
    std::map<std::string, std::string> metadata;
    /// How the file's values were encoded; the image's own values are linear once read. Kind::linear for
    /// float files.
    Encoding encoding = Encoding::linear();
    /// Bits of a channel in the file: 8, 16 or 32.
    int bits = 32;

    bool operator==(const ImageInfo&) const = default;
};

/// Linear float pixels, row-major, interleaved, top row first.
class Image {
  public:
    /// The longest side an image may have.
    static constexpr int max_side = 65536;
    /// The most floats an image may have: 2 GiB of them.
    static constexpr std::size_t max_values = std::size_t{1} << 29;

    Image() = default;
    /// All zero. Throws std::runtime_error when a side is not in 1 ... max_side, there are no channels, or
    /// the whole is larger than max_values.
    Image(int width, int height, std::vector<std::string> channel_names);
    /// Three channels R, G, B.
    static Image rgb_image(int width, int height) { return {width, height, {"R", "G", "B"}}; }
    /// One channel Y.
    static Image grey_image(int width, int height) { return {width, height, {"Y"}}; }

    int width() const { return width_; }
    int height() const { return height_; }
    Vec2i size() const { return {width_, height_}; }
    bool empty() const { return values_.empty(); }
    /// Number of channels.
    int channels() const { return static_cast<int>(names_.size()); }
    const std::vector<std::string>& channel_names() const { return names_; }
    /// Where the channel of this name is; layers are part of the name ("albedo.R").
    std::optional<int> channel_index(std::string_view name) const;

    float& at(int x, int y, int c = 0) { return values_[index(x, y) + static_cast<std::size_t>(c)]; }
    float at(int x, int y, int c = 0) const { return values_[index(x, y) + static_cast<std::size_t>(c)]; }
    /// The channels of one pixel.
    std::span<float> pixel(int x, int y) { return {&values_[index(x, y)], names_.size()}; }
    std::span<const float> pixel(int x, int y) const { return {&values_[index(x, y)], names_.size()}; }
    /// All values: width * height * channels floats.
    std::span<float> values() { return values_; }
    std::span<const float> values() const { return values_; }

    /// The colour: channels R, G and B when all are there, else the first channel three times.
    Vec3 rgb(int x, int y) const {
        const float* p = &values_[index(x, y)];
        return {p[rgb_[0]], p[rgb_[1]], p[rgb_[2]]};
    }
    /// Sets what rgb() reads; a grey image is given the Rec. 709 luminance.
    void set_rgb(int x, int y, Vec3 color);
    /// Whether rgb() reads three different channels.
    bool has_rgb() const { return rgb_[0] != rgb_[1]; }

    /// The pixels of r, which must lie inside and not be empty (std::runtime_error). The info's origin
    /// follows.
    Image crop(Rect2i r) const;
    /// The channels of these names in this order. Throws std::runtime_error naming the one that is missing.
    Image select(std::span<const std::string> names) const;
    /// Channels R, G, B as rgb() gives them.
    Image to_rgb() const;

    ImageInfo info;

  private:
    std::size_t index(int x, int y) const {
        assert(x >= 0 && x < width_ && y >= 0 && y < height_);
        return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                static_cast<std::size_t>(x)) *
               names_.size();
    }

    int width_ = 0, height_ = 0;
    std::vector<std::string> names_;
    std::size_t rgb_[3] = {0, 0, 0};
    std::vector<float> values_;
};

/// Throws std::runtime_error saying what is wrong when an image of this size would be refused.
void check_image_size(long long width, long long height, long long channels);

} // namespace alhazen
