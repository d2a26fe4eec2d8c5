/// Halton sampling (Halton 1964): dimension d mirrors the digits of the point's number, written in the d-th
/// prime, at the decimal point. One sequence for the image, its first two dimensions stretched over a tile of
/// pixels that repeats (Gruenschloss, Raab and Keller 2012).
#include "samplers/common.h"

namespace alhazen {

enum class HaltonRandomization { none, permutedigits, owen };
template <>
struct EnumNames<HaltonRandomization> {
    static constexpr std::array names{"none", "permutedigits", "owen"};
};

namespace {

// Higher dimensions need very many points to fill, and their tables would be large; independent numbers serve
// better.
constexpr std::uint32_t halton_dimensions = 256;
// Pixels on a side after which the pattern repeats: keeps the indices small.
constexpr int largest_tile = 128;

constexpr std::array<std::uint16_t, halton_dimensions> make_primes() {
    std::array<std::uint16_t, halton_dimensions> primes{};
    std::size_t n = 0;
    for (unsigned candidate = 2; n < primes.size(); ++candidate) {
        bool is_prime = true;
        for (std::size_t i = 0; i < n && primes[i] * primes[i] <= candidate && is_prime; ++i)
            is_prime = candidate % primes[i] != 0;
        if (is_prime) primes[n++] = static_cast<std::uint16_t>(candidate);
    }
    return primes;
}
constexpr std::array<std::uint16_t, halton_dimensions> primes = make_primes();

struct Division {
    std::uint64_t quotient;
    std::uint32_t digit;
};
inline Division divide(std::uint64_t a, std::uint32_t base) {
    // Most indices fit 32 bits, whose division is several times as fast.
    if (a <= 0xffffffffu) {
        auto small = static_cast<std::uint32_t>(a);
        return {small / base, small % base};
    }
    return {a / base, static_cast<std::uint32_t>(a % base)};
}

float to_unit(std::uint64_t reversed, double scale) {
    return std::min(static_cast<float>(static_cast<double>(reversed) * scale), one_minus_epsilon);
}

// All digits of a, mirrored.
float radical_inverse(std::uint64_t a, std::uint32_t base) {
    const double inverse = 1.0 / base;
    double scale = 1;
    std::uint64_t reversed = 0;
    while (a != 0) {
        auto [quotient, digit] = divide(a, base);
        reversed = reversed * base + digit;
        scale *= inverse;
        a = quotient;
    }
    return to_unit(reversed, scale);
}

// The number below base^digits whose mirrored digits, as an integer, are v.
std::uint64_t mirrored_integer(std::uint64_t v, std::uint32_t base, int digits) {
    std::uint64_t result = 0;
    for (int i = 0; i < digits; ++i, v /= base) result = result * base + v % base;
    return result;
}

// Digits after the point that a float can show, for each dimension.
constexpr std::array<std::uint8_t, halton_dimensions> make_digit_counts() {
    std::array<std::uint8_t, halton_dimensions> counts{};
    for (std::size_t d = 0; d < counts.size(); ++d)
        for (double power = 1; power < 0x1p24; power *= primes[d]) ++counts[d];
    return counts;
}
constexpr std::array<std::uint8_t, halton_dimensions> digit_counts = make_digit_counts();

// Scrambled fraction digit by digit; permute(place, digit, digits before) gives the new digit.
template <class Permute>
float permuted_radical_inverse(std::uint64_t a, std::uint32_t base, int digits, Permute permute) {
    const double inverse = 1.0 / base;
    double scale = 1;
    std::uint64_t reversed = 0;
    for (int i = 0; i < digits; ++i) {
        auto [quotient, digit] = divide(a, base);
        reversed = reversed * base + permute(i, digit, reversed);
        scale *= inverse;
        a = quotient;
    }
    return to_unit(reversed, scale);
}

// Random orders of the digits, one for each dimension and place.
class DigitOrders {
  public:
    DigitOrders() = default;
    explicit DigitOrders(std::uint64_t seed) {
        for (std::size_t d = 0; d < halton_dimensions; ++d) {
            starts_[d] = static_cast<std::uint32_t>(table_.size());
            for (int place = 0; place < digit_counts[d]; ++place) {
                std::uint64_t key = hash_of(seed, d, static_cast<std::uint64_t>(place));
                for (std::uint32_t v = 0; v < primes[d]; ++v)
                    table_.push_back(static_cast<std::uint16_t>(permuted_index(v, primes[d], key)));
            }
        }
    }
    const std::uint16_t* of(std::uint32_t dimension) const { return table_.data() + starts_[dimension]; }

  private:
    std::vector<std::uint16_t> table_;
    std::array<std::uint32_t, halton_dimensions> starts_{};
};

class HaltonSampler final : public CountedSampler {
  public:
    HaltonRandomization randomization = HaltonRandomization::permutedigits;

    static void describe(Fields<HaltonSampler>& f) {
        f.about("One Halton sequence for the image; any number of samples is as good as a power of two. "
                "Dimensions beyond the 256th are independent random numbers.");
        describe_count(f);
        f.field("randomization", &HaltonSampler::randomization, "how the points are made random");
        describe_seed(f);
        f.example("none", {make_string("randomization", "none")});
        f.example("owen", {make_string("randomization", "owen")});
    }
    void finish(const Node&, BuildContext&) { prepare({1, 1}, pixelsamples, 0); }

    SampleState start(Vec2i pixel, std::uint32_t sample) const override {
        auto in_tile = [](int v) {
            return static_cast<std::uint64_t>(static_cast<unsigned>(v) % largest_tile);
        };
        // The Chinese remainder theorem joins what the columns demand of the index and what the rows do.
        std::uint64_t index = mirrored_integer(in_tile(pixel.x), 2, exponents_[0]) * factors_[0] +
                              mirrored_integer(in_tile(pixel.y), 3, exponents_[1]) * factors_[1];
        std::uint64_t stride = std::uint64_t{scales_[0]} * scales_[1];
        return {pixel, sample, 2, index % stride + sample * stride};
    }
    float next1(SampleState& state) const override { return coordinate(state, state.dimension++); }
    Vec2 next2(SampleState& state) const override {
        float x = coordinate(state, state.dimension);
        float y = coordinate(state, state.dimension + 1);
        state.dimension += 2;
        return {x, y};
    }
    /// The first two dimensions; the digits that name the pixel are taken off.
    Vec2 pixel2(SampleState& state) const override {
        std::uint64_t a = state.index / scales_[0], b = state.index / scales_[1];
        std::uint64_t column = sub_key(seed_ ^ column_salt, static_cast<std::uint32_t>(state.pixel.x));
        std::uint64_t row = sub_key(seed_ ^ row_salt, static_cast<std::uint32_t>(state.pixel.y));
        switch (randomization) {
        case HaltonRandomization::none:
            return {radical_inverse(a, 2), radical_inverse(b, 3)};
        case HaltonRandomization::permutedigits:
            return {shifted(a, 0, column), shifted(b, 1, row)};
        case HaltonRandomization::owen:
            break;
        }
        return {scrambled(a, 0, column), scrambled(b, 1, row)};
    }
    /// Both bases come round together.
    bool is_even(int samples) const override {
        while (samples % 6 == 0) samples /= 6;
        return samples == 1;
    }
    void prepare(Vec2i resolution, int samples_per_pixel, std::uint64_t seed_of_render) override {
        CountedSampler::prepare(resolution, samples_per_pixel, seed_of_render);
        for (std::size_t i = 0; i < 2; ++i) {
            const std::uint32_t base = primes[i];
            int size = std::min(i == 0 ? resolution.x : resolution.y, largest_tile);
            scales_[i] = 1;
            exponents_[i] = 0;
            for (; static_cast<int>(scales_[i]) < size; scales_[i] *= base) ++exponents_[i];
        }
        // factors_[i] is 1 modulo its own scale and 0 modulo the other's.
        for (std::size_t i = 0; i < 2; ++i) {
            const std::uint64_t own = scales_[i], other = scales_[1 - i];
            factors_[i] = other;
            while (own > 1 && factors_[i] % own != 1) factors_[i] += other;
        }
        if (randomization == HaltonRandomization::permutedigits) orders_ = DigitOrders(seed_);
    }

  private:
    // Every digit turned by an amount of its own that the key chooses: the digits that are left within a
    // pixel are few, and alike in all pixels, so that each column and row needs an order of its own.
    static float shifted(std::uint64_t index, std::uint32_t dimension, std::uint64_t key) {
        const std::uint32_t base = primes[dimension];
        return permuted_radical_inverse(index, base, digit_counts[dimension],
                                        [=](int, std::uint32_t digit, std::uint64_t) mutable {
                                            auto turn = static_cast<std::uint32_t>(key % base);
                                            key /= base;
                                            return digit + turn < base ? digit + turn : digit + turn - base;
                                        });
    }
    float coordinate(const SampleState& state, std::uint32_t dimension) const {
        std::uint64_t key = sub_key(seed_, dimension);
        if (dimension >= halton_dimensions)
            return unit_float(hash_of(key, state.index, pixel_key(state.pixel)));
        return randomization == HaltonRandomization::none ? radical_inverse(state.index, primes[dimension])
                                                          : scrambled(state.index, dimension, key);
    }
    float scrambled(std::uint64_t index, std::uint32_t dimension, std::uint64_t key) const {
        const std::uint32_t base = primes[dimension];
        const int digits = digit_counts[dimension];
        if (randomization == HaltonRandomization::permutedigits) {
            const std::uint16_t* orders = orders_.of(dimension);
            return permuted_radical_inverse(
                index, base, digits, [=](int place, std::uint32_t digit, std::uint64_t) {
                    return orders[static_cast<std::uint32_t>(place) * base + digit];
                });
        }
        return permuted_radical_inverse(
            index, base, digits, [=](int place, std::uint32_t digit, std::uint64_t before) {
                std::uint64_t node = before * 64 + static_cast<std::uint64_t>(place);
                return permuted_index(digit, base, sub_key(key, node));
            });
    }

    std::array<std::uint32_t, 2> scales_{1, 1};
    std::array<int, 2> exponents_{0, 0};
    std::array<std::uint64_t, 2> factors_{1, 1};
    DigitOrders orders_;
};

} // namespace

Kind<Sampler> halton_sampler() {
    return make_kind<Sampler, HaltonSampler>("halton");
}

} // namespace alhazen
