/// Padded Sobol' sampling: every number and every pair is the first or the first two dimensions of the
/// sequence, randomized anew, with the samples in a shuffled order (Burley 2020, "Practical hash-based Owen
/// scrambling"). The shuffle is an Owen scrambling of the sample's number, so that any first 2^k samples are
/// spread evenly.
#include "samplers/randomized_sobol.h"

namespace alhazen {

namespace {

class PaddedSobolSampler final : public RandomizedSobol {
  public:
    static void describe(Fields<PaddedSobolSampler>& f) {
        f.about("Every number and pair of numbers is spread evenly over the pixel's samples; pixels and "
                "dimensions "
                "are independent of each other.");
        describe_sobol(f);
    }

    SampleState start(Vec2i pixel, std::uint32_t sample) const override {
        return {pixel, sample, 0, mix_bits(seed_ ^ pixel_key(pixel))};
    }
    float next1(SampleState& state) const override {
        std::uint64_t key = sub_key(state.index, state.dimension);
        state.dimension += 1;
        return randomized_float(randomization, shuffled(state.sample, key), static_cast<std::uint32_t>(key));
    }
    Vec2 next2(SampleState& state) const override {
        std::uint64_t key = sub_key(state.index, state.dimension);
        state.dimension += 2;
        return sobol_pair(randomization, shuffled(state.sample, key), mix_bits(key));
    }

  private:
    static std::uint32_t shuffled(std::uint32_t sample, std::uint64_t key) {
        return reverse_bits(hash_owen(reverse_bits(sample), static_cast<std::uint32_t>(key >> 32)));
    }
};

} // namespace

Kind<Sampler> paddedsobol_sampler() {
    return make_kind<Sampler, PaddedSobolSampler>("paddedsobol");
}

} // namespace alhazen
