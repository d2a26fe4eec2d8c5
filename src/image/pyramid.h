/// Mip pyramids (Williams 1983): an image at full size, half, a quarter ... down to one pixel, so that a
/// lookup over a wide footprint reads few texels. Coordinates (u, v) run over the unit square with (0, 0) at
/// the upper left corner of the image and v downwards; texel (x, y) has its centre at ((x + 1/2) / width, (y
/// + 1/2) / height).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "image/image.h"

namespace alhazen {

/// What lies beyond an image's border.
enum class WrapMode {
    repeat,
    clamp,
    /// Zero.
    black,
    /// The octahedral map of the sphere (Clarberg 2008): neighbours across the border are neighbours on the
    /// sphere.
    octahedral_sphere
};
/// "repeat", "clamp", "black", "octahedralsphere".
std::optional<WrapMode> parse_wrap_mode(std::string_view name);

/// The texel that stands for p, which may lie anywhere outside; nullopt: black.
std::optional<Vec2i> wrap_coordinate(WrapMode mode, Vec2i p, Vec2i size);

/// One of the four texels of a bilinear lookup. Black texels beyond the border have weight 0 and lie at (0,
/// 0).
struct BilinearTap {
    Vec2i texel;
    float weight = 0;
};
/// Weights sum to 1 (less where black is part). uv that is not finite is taken for (0, 0).
std::array<BilinearTap, 4> bilinear_taps(WrapMode mode, Vec2 uv, Vec2i size);
/// The texel that uv lies in; nullopt: black.
std::optional<Vec2i> nearest_texel(WrapMode mode, Vec2 uv, Vec2i size);

/// Lookups in a pyramid of texels of any type T with + and * float, wherever they lie. Pyramid has
///     int levels() const;  Vec2i size(int level = 0) const;  WrapMode wrap_mode() const;
/// and level(i), which has a size and the texels at(Vec2i).
template <class Pyramid, class T>
class PyramidLookups {
  public:
    /// Bilinear lookup of evaluate(texel), whose result needs + and * float: texels are interpolated after
    /// they were turned into something that may be (spectrum coefficients, for example, may not).
    template <class F>
    auto bilinear(int level, Vec2 uv, F evaluate) const {
        using R = std::decay_t<decltype(evaluate(std::declval<const T&>()))>;
        const auto& l = self().level(level);
        R sum{};
        for (const BilinearTap& tap : bilinear_taps(self().wrap_mode(), uv, l.size))
            if (tap.weight != 0) sum = sum + evaluate(l.at(tap.texel)) * tap.weight;
        return sum;
    }
    /// Between the two levels whose texels are nearest to `width`, a footprint in units of the image's longer
    /// side.
    template <class F>
    auto trilinear(Vec2 uv, float width, F evaluate) const {
        float l = continuous_level(width);
        int lower = static_cast<int>(l);
        auto a = bilinear(lower, uv, evaluate);
        if (lower + 1 >= self().levels()) return a;
        float t = l - static_cast<float>(lower);
        return t == 0 ? a : a * (1 - t) + bilinear(lower + 1, uv, evaluate) * t;
    }
    /// The level, a fraction in 0 ... self().levels() - 1, whose texels are `width` wide.
    float continuous_level(float width) const {
        float top = static_cast<float>(self().levels() - 1);
        float texels = width * static_cast<float>(std::max(self().size().x, self().size().y));
        if (!(texels > 1)) return 0;
        return std::min(std::log2(texels), top);
    }

    /// Over an ellipse with axes a and b (units of the image's sides), by a Gaussian that ends at its rim
    /// (Greene and Heckbert 1986; Heckbert 1989, section 3.5): between the two levels on which the short axis
    /// is one to two texels. An ellipse more than max_anisotropy times as long as it is wide is made wider.
    template <class F>
    auto ewa(Vec2 uv, Vec2 a, Vec2 b, float max_anisotropy, F evaluate) const {
        if (length_squared(a) < length_squared(b)) std::swap(a, b);
        float longer = length(a), shorter = length(b);
        if (shorter * max_anisotropy < longer && shorter > 0) {
            const float wider = longer / (shorter * max_anisotropy);
            b *= wider;
            shorter *= wider;
        }
        if (!(shorter > 0) || !std::isfinite(longer)) return bilinear(0, uv, evaluate);
        const float l = continuous_level(shorter);
        const int lower = static_cast<int>(l);
        if (lower + 1 >= self().levels()) return bilinear(self().levels() - 1, uv, evaluate);
        const float t = l - static_cast<float>(lower);
        auto fine = over_ellipse(lower, uv, a, b, evaluate);
        return t == 0 ? fine : fine * (1 - t) + over_ellipse(lower + 1, uv, a, b, evaluate) * t;
    }

  private:
    template <class F>
    auto over_ellipse(int level, Vec2 uv, Vec2 a, Vec2 b, F evaluate) const {
        using R = std::decay_t<decltype(evaluate(std::declval<const T&>()))>;
        const auto& l = self().level(level);
        const Vec2 scale{static_cast<float>(l.size.x), static_cast<float>(l.size.y)};
        const Vec2 center = uv * scale - Vec2(0.5f, 0.5f);
        a = a * scale;
        b = b * scale;
        // A x^2 + B x y + C y^2 < F, a texel wider all round so that it is never between texels.
        float A = sqr(a.y) + sqr(b.y) + 1, B = -2 * (a.x * a.y + b.x * b.y), C = sqr(a.x) + sqr(b.x) + 1;
        const float inv_f = 1 / (A * C - sqr(B) / 4);
        A *= inv_f;
        B *= inv_f;
        C *= inv_f;
        const float determinant = 4 * A * C - sqr(B);
        const float rx = 2 * std::sqrt(C / determinant), ry = 2 * std::sqrt(A / determinant);
        // Beyond what integers can count.
        if (!(std::abs(center.x) + rx < 1e9f && std::abs(center.y) + ry < 1e9f))
            return bilinear(level, uv, evaluate);
        R sum{};
        float weights = 0;
        for (int y = static_cast<int>(std::ceil(center.y - ry));
             y <= static_cast<int>(std::floor(center.y + ry)); ++y)
            for (int x = static_cast<int>(std::ceil(center.x - rx));
                 x <= static_cast<int>(std::floor(center.x + rx)); ++x) {
                const float dx = static_cast<float>(x) - center.x, dy = static_cast<float>(y) - center.y;
                const float r2 = A * dx * dx + B * dx * dy + C * dy * dy;
                if (r2 >= 1) continue;
                const float weight = std::exp(-2 * r2) - std::exp(-2.0f);
                weights += weight;
                if (auto p = wrap_coordinate(self().wrap_mode(), {x, y}, l.size))
                    sum = sum + evaluate(l.at(*p)) * weight;
            }
        return weights > 0 ? sum * (1 / weights) : bilinear(level, uv, evaluate);
    }

    const Pyramid& self() const { return static_cast<const Pyramid&>(*this); }
};

/// A pyramid in memory (of float, Vec3, or what `map` made of them).
template <class T>
class Pyramid : public PyramidLookups<Pyramid<T>, T> {
  public:
    using PyramidLookups<Pyramid<T>, T>::bilinear;
    using PyramidLookups<Pyramid<T>, T>::trilinear;

    struct Level {
        Vec2i size;
        std::vector<T> texels; ///< row-major, top row first

        const T& at(Vec2i p) const {
            return texels[static_cast<std::size_t>(p.y) * static_cast<std::size_t>(size.x) +
                          static_cast<std::size_t>(p.x)];
        }
    };

    Pyramid() = default;
    Pyramid(std::vector<Level> levels, WrapMode mode) : levels_(std::move(levels)), mode_(mode) {}

    /// 1 + floor(log2(longer side)), or 1 when made without reduced levels.
    int levels() const { return static_cast<int>(levels_.size()); }
    Vec2i size(int level = 0) const { return levels_[static_cast<std::size_t>(level)].size; }
    const Level& level(int i) const { return levels_[static_cast<std::size_t>(i)]; }
    WrapMode wrap_mode() const { return mode_; }
    std::size_t bytes() const {
        std::size_t sum = 0;
        for (const Level& l : levels_) sum += l.texels.size() * sizeof(T);
        return sum;
    }

    /// x and y may lie outside.
    T texel(int level, int x, int y) const {
        auto p = wrap_coordinate(mode_, {x, y}, size(level));
        return p ? this->level(level).at(*p) : T{};
    }
    T nearest(int level, Vec2 uv) const {
        auto p = nearest_texel(mode_, uv, size(level));
        return p ? this->level(level).at(*p) : T{};
    }
    T bilinear(int level, Vec2 uv) const {
        return bilinear(level, uv, [](const T& t) { return t; });
    }
    /// Between the two levels whose texels are nearest to `width`, a footprint in units of the image's longer
    /// side.
    T trilinear(Vec2 uv, float width) const {
        return trilinear(uv, width, [](const T& t) { return t; });
    }

    /// The pyramid of f(texel).
    template <class F>
    auto map(F f) const {
        using U = std::decay_t<decltype(f(std::declval<const T&>()))>;
        std::vector<typename Pyramid<U>::Level> out;
        for (const Level& l : levels_) {
            typename Pyramid<U>::Level mapped{l.size, {}};
            mapped.texels.reserve(l.texels.size());
            for (const T& t : l.texels) mapped.texels.push_back(f(t));
            out.push_back(std::move(mapped));
        }
        return Pyramid<U>(std::move(out), mode_);
    }

  private:
    std::vector<Level> levels_;
    WrapMode mode_ = WrapMode::repeat;
};

/// The pyramid of one channel; every level is the box-filtered image of half the size, rounded down (at least
/// 1). Without reduced levels it holds the image alone.
Pyramid<float> channel_pyramid(const Image& image, int channel, WrapMode mode, bool reduced_levels = true);
/// The pyramid of the colour, Image::rgb.
Pyramid<Vec3> rgb_pyramid(const Image& image, WrapMode mode, bool reduced_levels = true);

} // namespace alhazen
