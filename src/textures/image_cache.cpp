#include "textures/image_cache.h"

#include "image/codec.h"

namespace alhazen {

ImageCache::ImageKey ImageCache::key(const ImageSource& source) {
    // Two spellings of one path are one file.
    std::error_code error;
    std::filesystem::path path = std::filesystem::weakly_canonical(source.path, error);
    return {(error ? source.path : path).string(), source.encoding.kind, source.encoding.gamma};
}

std::shared_ptr<const Image> ImageCache::image(const ImageSource& source) {
    std::lock_guard lock(mutex_);
    auto& entry = images_[key(source)];
    if (!entry) {
        entry = std::make_shared<Image>(read_image(source.path, {source.encoding}));
        ++decoded_;
    }
    return entry;
}

std::shared_ptr<const Pyramid<float>> ImageCache::numbers(const ImageSource& source) {
    std::lock_guard lock(mutex_);
    auto& entry = numbers_[{key(source), source.wrap}];
    if (!entry) {
        entry = std::make_shared<Pyramid<float>>(make_float_texels(*image(source), source.wrap));
        made_numbers_.push_back(entry);
    }
    return entry;
}

std::shared_ptr<const ColorTexels> ImageCache::colors(const ImageSource& source, TexelAdjustment adjustment,
                                                      SpectrumRole role, ColorMode mode) {
    std::lock_guard lock(mutex_);
    auto& entry = colors_[{key(source), source.wrap, adjustment.scale, adjustment.invert, role, mode}];
    if (!entry) {
        entry = make_color_texels(*image(source), source.wrap, adjustment, role, mode);
        made_colors_.push_back(entry);
    }
    return entry;
}

void ImageCache::clear() {
    std::lock_guard lock(mutex_);
    images_.clear();
    numbers_.clear();
    colors_.clear();
}

std::size_t ImageCache::bytes() const {
    std::lock_guard lock(mutex_);
    std::size_t sum = 0;
    for (const auto& [source, image] : images_)
        if (image) sum += image->values().size() * sizeof(float);
    for (const auto& texels : made_numbers_)
        if (auto held = texels.lock()) sum += held->bytes();
    for (const auto& texels : made_colors_)
        if (auto held = texels.lock()) sum += held->bytes();
    return sum;
}

} // namespace alhazen
