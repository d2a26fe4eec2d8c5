#include "textures/image_cache.h"

#include "image/codec.h"

namespace alhazen {

ImageCache::ImageKey ImageCache::key(const ImageSource& source) {
    // Two spellings of one path are one file.
    std::error_code error;
    std::filesystem::path path = std::filesystem::weakly_canonical(source.path, error);
    return {(error ? source.path : path).string(), source.encoding.kind, source.encoding.gamma};
}

template <class T, class Key, class Make>
std::shared_ptr<const T> ImageCache::once(Entries<Key, T>& entries, const Key& key, const Make& make) {
    std::unique_lock lock(mutex_);
    std::shared_ptr<Entry<T>> entry = entries.try_emplace(key, std::make_shared<Entry<T>>()).first->second;
    lock.unlock();
    std::lock_guard making(entry->making);
    if (entry->made) return entry->made;
    std::shared_ptr<const T> made = make();
    lock.lock();
    entry->made = made;
    return made;
}

std::shared_ptr<const Image> ImageCache::image(const ImageSource& source) {
    return once(images_, key(source), [&] {
        auto image = std::make_shared<const Image>(read_image(source.path, {source.encoding}));
        ++decoded_;
        return image;
    });
}

std::shared_ptr<const FloatTexels> ImageCache::numbers(const ImageSource& source) {
    return once(numbers_, std::tuple(key(source), source.wrap), [&] {
        auto texels = maker_.numbers(*image(source), source.wrap);
        std::lock_guard lock(mutex_);
        made_numbers_.push_back(texels);
        return texels;
    });
}

std::shared_ptr<const ColorTexels> ImageCache::colors(const ImageSource& source, TexelAdjustment adjustment,
                                                      SpectrumRole role, ColorMode mode) {
    const ColorKey color_key{key(source), source.wrap, adjustment.scale, adjustment.invert, role, mode};
    return once(colors_, color_key, [&] {
        auto texels = maker_.colors(*image(source), source.wrap, adjustment, role, mode);
        std::lock_guard lock(mutex_);
        made_colors_.push_back(texels);
        return texels;
    });
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
    for (const auto& [source, entry] : images_)
        if (entry->made) sum += entry->made->values().size() * sizeof(float);
    for (const auto& texels : made_numbers_)
        if (auto held = texels.lock()) sum += held->bytes();
    for (const auto& texels : made_colors_)
        if (auto held = texels.lock()) sum += held->bytes();
    return sum;
}

} // namespace alhazen
