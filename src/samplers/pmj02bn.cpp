/// Progressive multi-jittered points with blue-noise dithering, as pbrt-v4's sampler of this name
/// (Christensen, Kensler and Kilpatrick 2018; Georgiev and Fajardo 2016): all pixels share few well-spread
/// sets of points, moved by offsets that make the errors of neighbours differ.
#include "samplers/blue_noise.h"
#include "samplers/common.h"
#include "samplers/pmj02.h"

namespace alhazen {

namespace {

class Pmj02bnSampler final : public CountedSampler {
  public:
    static void describe(Fields<Pmj02bnSampler>& f) {
        f.about("Progressive multi-jittered (0,2) points, alike in all pixels but for offsets of blue noise, "
                "so that what error is left looks finer. As in pbrt-v4, five sets of 65536 points; but they "
                "are made when rendering starts instead of read from pbrt's tables, and not chosen to keep "
                "their distance within a pixel; the 48 tables of blue noise are one, seen from different "
                "corners; and single numbers are not equally spaced, which would give all samples of a pixel "
                "the same wavelengths.");
        f.field("pixelsamples", &Pmj02bnSampler::pixelsamples,
                "samples taken in each pixel; a power of four spreads them best")
            .in(1, 1 << log2_points);
        describe_seed(f);
    }

    SampleState start(Vec2i pixel, std::uint32_t sample) const override {
        const std::uint64_t key = mix_bits(seed_ ^ pixel_key(pixel));
        // The place in the pixel has the first two dimensions.
        return {pixel, sample, 2, key};
    }
    float next1(SampleState& state) const override {
        const std::uint32_t n = count();
        const std::uint64_t key = key_of(state);
        const std::uint32_t cell = permuted_index(state.sample % n, n, key);
        // Unlike in pbrt each cell has a place of its own, by the golden ratio: a path's four wavelengths are
        // equally spaced, too, and those of one sample would else be those of the next.
        const float golden = unit_float(cell * 2654435769u);
        const float place = wrapped(wrapped(noise(state, state.dimension) + golden) + again(state, key).x);
        state.dimension += 1;
        return std::min((static_cast<float>(cell) + place) / static_cast<float>(n), one_minus_epsilon);
    }
    Vec2 next2(SampleState& state) const override {
        const std::uint64_t key = key_of(state);
        const std::size_t use = state.dimension / 2;
        std::uint32_t index = state.sample % count();
        // A set that is used again goes in another order.
        if (use >= sets) index = permuted_index(index, count(), key);
        const Vec2 p = points_[use % sets][index % points_[0].size()], more = again(state, key);
        const Vec2 u{wrapped(p.x + wrapped(noise(state, state.dimension) + more.x)),
                     wrapped(p.y + wrapped(noise(state, state.dimension + 1) + more.y))};
        state.dimension += 2;
        return u;
    }
    Vec2 pixel2(SampleState& state) const override {
        const int x = state.pixel.x & (tile_ - 1), y = state.pixel.y & (tile_ - 1);
        const auto in_pixel =
            static_cast<std::uint32_t>(pixel_points_.size()) / static_cast<std::uint32_t>(tile_ * tile_);
        const Vec2 p = pixel_points_[static_cast<std::size_t>(y * tile_ + x) * in_pixel +
                                     state.sample % count() % in_pixel];
        const Vec2 more = again(state, sub_key(state.index, 0));
        return {wrapped(p.x + more.x), wrapped(p.y + more.y)};
    }

    void prepare(Vec2i resolution, int samples_per_pixel, std::uint64_t seed_of_render) override {
        CountedSampler::prepare(resolution, samples_per_pixel, seed_of_render);
        for (std::size_t i = 0; i < sets; ++i) points_[i] = pmj02_points(log2_points, sub_key(seed_, i));
        set_pixel_points();
        blue_ = &BlueNoise::get();
    }

  private:
    static constexpr std::size_t sets = 5;
    static constexpr int log2_points = 16;

    /// The next power of four, at most what the sets have.
    static int tile_samples(int samples) {
        const int digits = log2_ceil(samples);
        return 1 << std::min(digits + digits % 2, log2_points);
    }
    std::uint32_t count() const { return static_cast<std::uint32_t>(pixelsamples); }
    static std::uint64_t key_of(const SampleState& state) { return sub_key(state.index, state.dimension); }
    static float wrapped(float u) { return std::min(u < 1 ? u : u - 1, one_minus_epsilon); }
    float noise(const SampleState& state, std::uint32_t dimension) const {
        return blue_->at(state.pixel, dimension, static_cast<std::uint32_t>(seed_));
    }
    /// An offset for samples beyond what there is: of the count, and of the points.
    Vec2 again(const SampleState& state, std::uint64_t key) const {
        const std::uint32_t limit = std::min(count(), 1u << log2_points);
        return state.sample < limit ? Vec2() : unit_pair(sub_key(key, state.sample / limit));
    }
    void set_pixel_points();

    const BlueNoise* blue_ = nullptr;
    std::array<std::vector<Vec2>, sets> points_;
    /// Points of the pixels in a tile of tile_ x tile_, pixel by pixel.
    std::vector<Vec2> pixel_points_;
    int tile_ = 1;
};

// The first set, spread over so many pixels that each gets one power of four of points.
void Pmj02bnSampler::set_pixel_points() {
    const int in_pixel = tile_samples(pixelsamples);
    tile_ = 1 << ((log2_points - log2_ceil(in_pixel)) / 2);
    pixel_points_.assign(points_[0].size(), Vec2());
    std::vector<int> used(static_cast<std::size_t>(tile_ * tile_));
    for (const Vec2 point : points_[0]) {
        const Vec2 p = point * static_cast<float>(tile_);
        const int x = static_cast<int>(p.x), y = static_cast<int>(p.y);
        const auto pixel = static_cast<std::size_t>(y * tile_ + x);
        pixel_points_[pixel * static_cast<std::size_t>(in_pixel) + static_cast<std::size_t>(used[pixel]++)] =
            {p.x - static_cast<float>(x), p.y - static_cast<float>(y)};
    }
}

} // namespace

Kind<Sampler> pmj02bn_sampler() {
    return make_kind<Sampler, Pmj02bnSampler>("pmj02bn");
}

} // namespace alhazen
