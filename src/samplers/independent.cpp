/// Independent uniform numbers: each is a hash of where it is used. The plainest sampler, and the one to
/// compare the others with.
#include "samplers/common.h"

namespace alhazen {

namespace {

class IndependentSampler final : public CountedSampler {
  public:
    IndependentSampler() { pixelsamples = 4; }

    static void describe(Fields<IndependentSampler>& f) {
        f.about("Independent random numbers, without any effort to spread them. Noisier than the other "
                "samplers.");
        describe_count(f);
        describe_seed(f);
        f.example("seeded", {make_integer("seed", 7)});
    }

    SampleState start(Vec2i pixel, std::uint32_t sample) const override {
        return {pixel, sample, 0, sub_key(mix_bits(seed_ ^ pixel_key(pixel)), sample)};
    }
    float next1(SampleState& state) const override {
        return unit_float(sub_key(state.index, state.dimension++));
    }
    Vec2 next2(SampleState& state) const override {
        Vec2 u = unit_pair(sub_key(state.index, state.dimension));
        state.dimension += 2;
        return u;
    }
};

} // namespace

Kind<Sampler> independent_sampler() {
    return make_kind<Sampler, IndependentSampler>("independent");
}

} // namespace alhazen
