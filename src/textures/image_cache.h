/// Images and their texels, each read and prepared once a scene however many textures show it.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>
#include <vector>

#include "textures/texels.h"

namespace alhazen {

/// What a texture shows.
struct ImageSource {
    std::filesystem::path path;
    Encoding encoding;
    WrapMode wrap = WrapMode::repeat;
};

/// May be used from several threads; a second thread waits for the first one's image.
class ImageCache {
  public:
    /// The decoded file. Throws std::runtime_error as read_image does.
    std::shared_ptr<const Image> image(const ImageSource& source);
    std::shared_ptr<const Pyramid<float>> numbers(const ImageSource& source);
    std::shared_ptr<const ColorTexels> colors(const ImageSource& source, TexelAdjustment adjustment,
                                              SpectrumRole role, ColorMode mode);
    /// Forgets everything; what textures hold stays theirs.
    void clear();
    /// Images read so far.
    std::size_t decoded() const { return decoded_; }
    /// Memory of the images kept here and of the texels that textures still hold, each counted once.
    std::size_t bytes() const;

  private:
    using ImageKey = std::tuple<std::string, Encoding::Kind, float>;
    using ColorKey = std::tuple<ImageKey, WrapMode, float, bool, SpectrumRole, ColorMode>;
    static ImageKey key(const ImageSource& source);

    mutable std::recursive_mutex mutex_;
    std::map<ImageKey, std::shared_ptr<const Image>> images_;
    std::map<std::tuple<ImageKey, WrapMode>, std::shared_ptr<const Pyramid<float>>> numbers_;
    std::map<ColorKey, std::shared_ptr<const ColorTexels>> colors_;
    // Everything made, forgotten or not, for as long as a texture holds it.
    std::vector<std::weak_ptr<const Pyramid<float>>> made_numbers_;
    std::vector<std::weak_ptr<const ColorTexels>> made_colors_;
    std::size_t decoded_ = 0;
};

} // namespace alhazen
