/// Images and their texels, each read and prepared once a scene however many textures show it.
#pragma once

#include <atomic>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <tuple>
#include <vector>

#include "base/made_once.h"
#include "textures/texels.h"

namespace alhazen {

/// What a texture shows.
struct ImageSource {
    std::filesystem::path path;
    Encoding encoding;
    WrapMode wrap = WrapMode::repeat;
};

/// May be used from several threads: different images are made at the same time; who wants one that another
/// thread is making waits for it.
class ImageCache {
  public:
    /// From now on texels lie in a temporary file, and at most so many bytes of them in memory; of decoded
    /// images no more than that are kept for further uses. To be called before anything is read.
    void limit_memory(std::size_t bytes);
    /// The decoded file. Throws std::runtime_error as read_image does.
    std::shared_ptr<const Image> image(const ImageSource& source);
    std::shared_ptr<const FloatTexels> numbers(const ImageSource& source);
    std::shared_ptr<const ColorTexels> colors(const ImageSource& source, TexelAdjustment adjustment,
                                              SpectrumRole role, ColorMode mode);
    /// Forgets everything, to be called when no other thread uses it; what textures hold stays theirs.
    void clear();
    /// Images read so far.
    std::size_t decoded() const { return decoded_; }
    /// Memory of the images kept here and of the texels that textures still hold, each counted once.
    std::size_t bytes() const;
    TextureMemory memory() const;
    /// Throws std::runtime_error if texels could not be read while they were looked up.
    void throw_if_failed() const;

  private:
    using ImageKey = std::tuple<std::filesystem::path, Encoding::Kind, float>;
    using ColorKey = std::tuple<ImageKey, WrapMode, float, bool, SpectrumRole, ColorMode>;
    static ImageKey key(const ImageSource& source);

    void drop_images(const ImageKey& newest);

    TexelMaker maker_;
    std::shared_ptr<TileCache> tiles_; ///< nullptr: no limit
    std::size_t limit_ = 0;
    std::deque<ImageKey> in_order_; ///< of images_, where there is a limit
    MadeOnce<ImageKey, Image> images_;
    MadeOnce<std::tuple<ImageKey, WrapMode>, FloatTexels> numbers_;
    MadeOnce<ColorKey, ColorTexels> colors_;
    mutable std::mutex mutex_; ///< of in_order_ and what follows
    // Everything made, forgotten or not, for as long as a texture holds it.
    std::vector<std::weak_ptr<const FloatTexels>> made_numbers_;
    std::vector<std::weak_ptr<const ColorTexels>> made_colors_;
    std::atomic<std::size_t> decoded_ = 0;
};

} // namespace alhazen
