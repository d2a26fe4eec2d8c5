#include "textures/image_cache.h"

#include "base/file.h"
#include "image/codec.h"

namespace alhazen {

namespace {

std::size_t size_in_memory(const Image& image) {
    return image.values().size() * sizeof(float);
}

} // namespace

ImageCache::ImageKey ImageCache::key(const ImageSource& source) {
    return {real_path(source.path), source.encoding.kind, source.encoding.gamma};
}

void ImageCache::limit_memory(std::size_t bytes) {
    limit_ = bytes;
    tiles_ = std::make_shared<TileCache>(bytes);
    maker_.keep_in(tiles_);
}

std::shared_ptr<const Image> ImageCache::image(const ImageSource& source) {
    const ImageKey image_key = key(source);
    bool is_new = false;
    auto image = images_.get(image_key, [&] {
        auto read = std::make_shared<const Image>(read_image(source.path, {source.encoding}));
        ++decoded_;
        is_new = true;
        return read;
    });
    if (is_new && tiles_) drop_images(image_key);
    return image;
}

// Forgets the images that were read first, until the others are within the limit.
void ImageCache::drop_images(const ImageKey& newest) {
    std::lock_guard lock(mutex_);
    in_order_.push_back(newest);
    auto size_of = [&](const ImageKey& image_key) {
        const auto image = images_.find(image_key);
        return image ? size_in_memory(*image) : 0;
    };
    std::size_t sum = 0;
    for (const ImageKey& kept : in_order_) sum += size_of(kept);
    while (sum > limit_) {
        sum -= size_of(in_order_.front());
        images_.forget(in_order_.front());
        in_order_.pop_front();
    }
}

std::shared_ptr<const FloatTexels> ImageCache::numbers(const ImageSource& source) {
    return numbers_.get({key(source), source.wrap}, [&] {
        auto texels = maker_.numbers(*image(source), source.wrap);
        std::lock_guard lock(mutex_);
        made_numbers_.push_back(texels);
        return texels;
    });
}

std::shared_ptr<const ColorTexels> ImageCache::colors(const ImageSource& source, TexelAdjustment adjustment,
                                                      SpectrumRole role, ColorMode mode) {
    const ColorKey color_key{key(source), source.wrap, adjustment.scale, adjustment.invert, role, mode};
    return colors_.get(color_key, [&] {
        auto texels = maker_.colors(*image(source), source.wrap, adjustment, role, mode);
        std::lock_guard lock(mutex_);
        made_colors_.push_back(texels);
        return texels;
    });
}

void ImageCache::clear() {
    std::lock_guard lock(mutex_);
    in_order_.clear();
    images_.forget_all();
    numbers_.forget_all();
    colors_.forget_all();
}

std::size_t ImageCache::bytes() const {
    std::lock_guard lock(mutex_);
    std::size_t sum = tiles_ ? tiles_->bytes() : 0;
    images_.for_each([&](const Image& image) { sum += size_in_memory(image); });
    for (const auto& texels : made_numbers_)
        if (auto held = texels.lock()) sum += held->bytes();
    for (const auto& texels : made_colors_)
        if (auto held = texels.lock()) sum += held->bytes();
    return sum;
}

TextureMemory ImageCache::memory() const {
    if (tiles_) return tiles_->memory();
    TextureMemory memory;
    memory.peak_bytes = bytes();
    return memory;
}

void ImageCache::throw_if_failed() const {
    if (tiles_) tiles_->throw_if_failed();
}

} // namespace alhazen
