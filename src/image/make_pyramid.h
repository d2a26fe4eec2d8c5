/// How pyramids are made of images, on the threads of the enclosing with_threads.
#pragma once

#include <functional>
#include <span>

#include "base/threads.h"
#include "image/pyramid.h"

namespace alhazen {

/// Fills out with the texels of the rows first ... last - 1 of an image. What a texel becomes depends on its
/// own pixel only; may be called from several threads.
template <class T>
using FillRows = std::function<void(const Image& image, int first, int last, std::span<T> out)>;

/// Calls use(level) for the image, and then, if wanted, for each box-filtered image of half the size, rounded
/// down (at least 1), to the last of one pixel.
void for_each_level(Image image, bool reduced_levels, const std::function<void(const Image&)>& use);

/// Rows that are worth a thread's while.
inline std::size_t rows_at_a_time(const Image& image) {
    return 1 + 32768 / static_cast<std::size_t>(image.width());
}

template <class T>
Pyramid<T> make_pyramid(Image image, WrapMode mode, bool reduced_levels, const FillRows<T>& fill) {
    std::vector<typename Pyramid<T>::Level> levels;
    for_each_level(std::move(image), reduced_levels, [&](const Image& level) {
        const auto width = static_cast<std::size_t>(level.width());
        const auto height = static_cast<std::size_t>(level.height());
        std::vector<T> texels(width * height);
        parallel_ranges(height, rows_at_a_time(level), [&](std::size_t first, std::size_t last) {
            fill(level, static_cast<int>(first), static_cast<int>(last),
                 std::span(texels).subspan(first * width, (last - first) * width));
        });
        levels.push_back({level.size(), std::move(texels)});
    });
    return {std::move(levels), mode};
}

/// From what a pixel becomes.
template <class T, class TexelAt>
FillRows<T> fill_each(TexelAt texel_at) {
    return [texel_at](const Image& image, int first, int last, std::span<T> out) {
        std::size_t i = 0;
        for (int y = first; y < last; ++y)
            for (int x = 0; x < image.width(); ++x) out[i++] = texel_at(image, x, y);
    };
}

} // namespace alhazen
