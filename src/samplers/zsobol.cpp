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

// The 24 orders of four things, each in a byte: bits 2 i and 2 i + 1 say where i goes.
constexpr std::array<std::uint8_t, 24> make_orders() {
    std::array<std::uint8_t, 24> orders{};
    std::size_t n = 0;
    for (unsigned a = 0; a < 4; ++a)
        for (unsigned b = 0; b < 4; ++b)
            for (unsigned c = 0; c < 4; ++c)
                if (a != b && a != c && b != c)
                    orders[n++] = static_cast<std::uint8_t>(a | (b << 2) | (c << 4) | ((6 - a - b - c) << 6));
    return orders;
}
constexpr std::array<std::uint8_t, 24> orders_of_four = make_orders();

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
        return {pixel, sample, 0, (morton(pixel) << log2_samples_) | within};
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
        end_ = std::min(2 * levels + log2_samples_, 60);
    }

  private:
    // Samples beyond the prepared number take another shuffle of the curve.
    std::uint64_t dimension_key(const SampleState& state) const {
        return sub_key(seed_, state.dimension + (std::uint64_t{state.sample >> log2_samples_} << 32));
    }
    // The index with each base-4 digit replaced according to an order that the digits above it choose. One
    // hash serves two digits: it holds an order for the upper one, and for the lower one an order for each
    // value of the upper. A count that is no power of four leaves one binary digit at the end.
    std::uint64_t shuffled(std::uint64_t index, std::uint64_t key) const {
        const int odd = log2_samples_ & 1;
        std::uint64_t result = odd ? (index ^ mix_bits((index >> 1) ^ key)) & 1 : 0;
        for (int shift = odd; shift < end_; shift += 4) {
            const std::uint64_t above = shift + 4 < 64 ? index >> (shift + 4) : 0;
            const std::uint64_t h = node_hash(above ^ key, shift);
            const std::uint64_t upper = (index >> (shift + 2)) & 3, lower = (index >> shift) & 3;
            result |= reordered(h, upper) << (shift + 2);
            result |= reordered(h >> (12 + 12 * upper), lower) << shift;
        }
        return result;
    }
    // mix_bits less what a key that is mixed already makes superfluous.
    static std::uint64_t node_hash(std::uint64_t v, int level) {
        v = (v + static_cast<std::uint64_t>(level)) * 0xbf58476d1ce4e5b9u;
        v ^= v >> 32;
        v *= 0x94d049bb133111ebu;
        return v ^ (v >> 29);
    }
    // Where the order that the lowest 12 bits choose puts a digit.
    static std::uint64_t reordered(std::uint64_t bits, std::uint64_t digit) {
        const unsigned order = orders_of_four[((bits & 0xfff) * 24) >> 12];
        return (order >> (2 * digit)) & 3;
    }

    int log2_samples_ = 4;
    int end_ = 4; ///< bits above this are 0 in every index
};

} // namespace

Kind<Sampler> zsobol_sampler() {
    return make_kind<Sampler, ZSobolSampler>("zsobol");
}

} // namespace alhazen
