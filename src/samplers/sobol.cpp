/// Global Sobol' sampling: one sequence for the whole image, its first two dimensions stretched over the
/// film, each pixel picking out the points that fall into it (Gruenschloss, Raab and Keller 2012,
/// "Enumerating quasi-Monte Carlo point sequences in elementary intervals"). All dimensions are spread
/// together.
#include "samplers/randomized_sobol.h"

namespace alhazen {

namespace {

// Which points of the sequence fall into a pixel of a 2^m x 2^m film. The first m digits of both coordinates
// of the point numbered (frame 2^2m + low) are linear in its bits; solving for low gives each pixel one point
// a frame.
class PixelIndex {
  public:
    explicit PixelIndex(int m) : m_(m) {
        const int n = 2 * m;
        // Row reduction of (A | I): column c of A is where bit c of low takes the pixel.
        std::vector<std::uint64_t> image(static_cast<std::size_t>(n)), origin(static_cast<std::size_t>(n));
        for (int c = 0; c < n; ++c) {
            image[at(c)] = pixel_bits(std::uint64_t{1} << c);
            origin[at(c)] = std::uint64_t{1} << c;
        }
        for (int bit = 0; bit < n; ++bit) {
            int pivot = bit;
            while (((image[at(pivot)] >> bit) & 1) == 0)
                ++pivot; // there is one: the points are a (0, 2)-sequence
            std::swap(image[at(bit)], image[at(pivot)]);
            std::swap(origin[at(bit)], origin[at(pivot)]);
            for (int other = 0; other < n; ++other)
                if (other != bit && ((image[at(other)] >> bit) & 1)) {
                    image[at(other)] ^= image[at(bit)];
                    origin[at(other)] ^= origin[at(bit)];
                }
        }
        from_pixel_ = origin;
        for (int c = 0; c + n < SobolMatrices::columns; ++c)
            from_frame_.push_back((std::uint64_t{1} << (c + n)) ^
                                  solve(pixel_bits(std::uint64_t{1} << (c + n))));
    }

    std::uint64_t index(Vec2i pixel, std::uint32_t frame) const {
        std::uint64_t bits = reversed_pixel(pixel.x) | (reversed_pixel(pixel.y) << m_);
        std::uint64_t result = solve(bits);
        for (std::uint64_t f = frame; f != 0; f &= f - 1) {
            auto c = static_cast<std::size_t>(std::countr_zero(f));
            if (c < from_frame_.size()) result ^= from_frame_[c];
        }
        return result;
    }

  private:
    static std::size_t at(int i) { return static_cast<std::size_t>(i); }
    // The pixel's coordinates with the highest bit first, x below y.
    std::uint64_t pixel_bits(std::uint64_t index) const {
        std::uint64_t mask = (std::uint64_t{1} << m_) - 1;
        return (sobol_first(index) & mask) | ((sobol_second(index) & mask) << m_);
    }
    std::uint64_t reversed_pixel(int v) const {
        return m_ == 0 ? 0 : reverse_bits(static_cast<std::uint32_t>(v)) >> (32 - m_);
    }
    std::uint64_t solve(std::uint64_t bits) const {
        std::uint64_t result = 0;
        for (; bits != 0; bits &= bits - 1) result ^= from_pixel_[at(std::countr_zero(bits))];
        return result;
    }

    int m_;
    std::vector<std::uint64_t> from_pixel_, from_frame_;
};

class SobolSampler final : public RandomizedSobol {
  public:
    static void describe(Fields<SobolSampler>& f) {
        f.about(
            "One sequence for the whole image, all dimensions of a path spread together. Dimensions beyond "
            "the 1024th are independent random numbers.");
        describe_sobol(f);
    }

    SampleState start(Vec2i pixel, std::uint32_t sample) const override {
        return {pixel, sample, 2, pixels_.index(pixel, sample)};
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
        auto x = static_cast<std::uint32_t>(sobol_first(state.index) >> log2_size_);
        auto y = static_cast<std::uint32_t>(sobol_second(state.index) >> log2_size_);
        // Scrambling may depend on the digits taken off, which are the pixel's row and column.
        std::uint64_t column = sub_key(seed_ ^ column_salt, static_cast<std::uint32_t>(state.pixel.x));
        std::uint64_t row = sub_key(seed_ ^ row_salt, static_cast<std::uint32_t>(state.pixel.y));
        return {randomized_float(randomization, x, static_cast<std::uint32_t>(column)),
                randomized_float(randomization, y, static_cast<std::uint32_t>(row))};
    }
    void prepare(Vec2i resolution, int samples_per_pixel, std::uint64_t seed_of_render) override {
        CountedSampler::prepare(resolution, samples_per_pixel, seed_of_render);
        log2_size_ = std::min(log2_ceil(std::max({resolution.x, resolution.y, 1})), 16);
        pixels_ = PixelIndex(log2_size_);
    }

  private:
    float coordinate(const SampleState& state, std::uint32_t dimension) const {
        std::uint64_t key = sub_key(seed_, dimension);
        if (dimension >= SobolMatrices::dimensions) return unit_float(sub_key(key, state.index));
        return randomized_float(randomization, matrices_.reversed(state.index, static_cast<int>(dimension)),
                                static_cast<std::uint32_t>(key));
    }

    const SobolMatrices& matrices_ = SobolMatrices::get();
    int log2_size_ = 0;
    PixelIndex pixels_{0};
};

} // namespace

Kind<Sampler> sobol_sampler() {
    return make_kind<Sampler, SobolSampler>("sobol");
}

} // namespace alhazen
