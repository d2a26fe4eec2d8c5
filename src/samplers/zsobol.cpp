/// Sobol' sampling in Morton order: one Sobol' sequence is dealt to the pixels along a Z-shaped curve that
/// has been shuffled at every level (Ahmed and Wonka 2020, "Screen-space blue-noise diffusion of Monte Carlo
/// sampling error via hierarchical ordering of pixels"). Any square of 2^k x 2^k pixels so shares an evenly
/// spread run of points, and neighbours' errors differ: the image's noise is fine-grained and fades at a
/// distance.
#include "samplers/randomized_sobol.h"

namespace alhazen {

namespace {

// Bits of v at the even places.
constexpr std::uint64_t spread_bits(std::uint32_t v) {
    std::uint64_t x = v;
    x = (x | (x << 16)) & 0x0000ffff0000ffffu;
    x = (x | (x << 8)) & 0x00ff00ff00ff00ffu;
    x = (x | (x << 4)) & 0x0f0f0f0f0f0f0f0fu;
    x = (x | (x << 2)) & 0x3333333333333333u;
    return (x | (x << 1)) & 0x5555555555555555u;
}
constexpr std::uint64_t morton(Vec2i p) {
    return spread_bits(static_cast<std::uint32_t>(p.x)) | (spread_bits(static_cast<std::uint32_t>(p.y)) << 1);
}

// Nested scrambling of a number's digits, from bit 0 on: each bit is flipped or not as the bits before it
// say (Laine and Karras 2011, in 64 bits). Even factors carry only upwards.
constexpr std::uint64_t scramble(std::uint64_t v, std::uint64_t seed) {
    v ^= v * 0x9e6c63d0676a9a98u;
    v += seed;
    v *= (seed >> 32) | 1;
    v ^= v * 0xd24d8ec38bbb4b5cu;
    v ^= v * 0x6f9f5b1aa2b6c2aau;
    return v;
}

class ZSobolSampler final : public RandomizedSobol {
  public:
    static void describe(Fields<ZSobolSampler>& f) {
        f.about("The default: evenly spread within each pixel and over neighbouring pixels together, so that "
                "what "
                "noise is left looks fine-grained.");
        describe_sobol(f);
    }

    SampleState start(Vec2i pixel, std::uint32_t sample) const override {
        std::uint32_t within = sample & ((1u << log2_samples_) - 1);
        return {pixel, sample, 0, reverse_bits((morton(pixel) << log2_samples_) | within)};
    }
    float next1(SampleState& state) const override {
        std::uint64_t key = dimension_key(state);
        state.dimension += 1;
        return randomized_float(randomization, static_cast<std::uint32_t>(shuffled(state.index, key)),
                                static_cast<std::uint32_t>(key));
    }
    Vec2 next2(SampleState& state) const override {
        std::uint64_t key = dimension_key(state);
        state.dimension += 2;
        return sobol_pair(randomization, shuffled(state.index, key), mix_bits(key));
    }
    void prepare(Vec2i resolution, int samples_per_pixel, std::uint64_t seed_of_render) override {
        CountedSampler::prepare(resolution, samples_per_pixel, seed_of_render);
        log2_samples_ = log2_ceil(samples_per_pixel);
        int levels = log2_ceil(std::max({resolution.x, resolution.y, 1}));
        const int end = std::min(2 * levels + log2_samples_, 62);
        used_ = (std::uint64_t{1} << end) - 1;
        digits_ = 0;
        for (int bit = end - 1; bit > 0; bit -= 2) digits_ |= std::uint64_t{1} << (63 - bit);
    }

  private:
    // Samples beyond the prepared number take another shuffle of the curve.
    std::uint64_t dimension_key(const SampleState& state) const {
        return sub_key(seed_, state.dimension + (std::uint64_t{state.sample >> log2_samples_} << 32));
    }
    // The index, given with its highest bit first, with each base-4 digit replaced according to an order that
    // the digits above it choose. Any order of four is a choice of pairs (which of the digit's bits, or their
    // sum, tells the pairs apart), and then the order of the pairs and within each, as binary scrambling
    // gives it. A count that is no power of four leaves one binary digit at the end.
    std::uint64_t shuffled(std::uint64_t index, std::uint64_t key) const {
        const std::uint64_t choice = scramble(index, std::rotl(key, 32));
        const std::uint64_t swaps = (index ^ (index >> 1)) & (choice << 2) & digits_;
        index ^= swaps | (swaps << 1);
        index ^= (index >> 1) & (choice << 1) & digits_;
        return reverse_bits(scramble(index, key)) & used_;
    }

    int log2_samples_ = 4;
    std::uint64_t used_ = 15; ///< bits that indices have
    std::uint64_t digits_ = std::uint64_t{5}
                            << 60; ///< the upper bit of each base-4 digit, with the highest bit first
};

} // namespace

Kind<Sampler> zsobol_sampler() {
    return make_kind<Sampler, ZSobolSampler>("zsobol");
}

} // namespace alhazen
