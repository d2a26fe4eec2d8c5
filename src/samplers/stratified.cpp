/// Stratified sampling: the unit square as a chessboard with one point in each field (Mitchell 1987). Each
/// dimension visits its fields in an order of its own, so that dimensions are not tied to each other.
#include <cmath>

#include "samplers/common.h"

namespace alhazen {

namespace {

class StratifiedSampler final : public CountedSampler {
  public:
    int xsamples = 4, ysamples = 4;
    bool jitter = true;

    static void describe(Fields<StratifiedSampler>& f) {
        f.about(
            "Each pixel has xsamples times ysamples samples; every number and pair of numbers is spread over "
            "as many equal cells, one sample in each.");
        f.field("xsamples", &StratifiedSampler::xsamples, "cells side by side").in(1, 4096);
        f.field("ysamples", &StratifiedSampler::ysamples, "cells above each other").in(1, 4096);
        f.field("jitter", &StratifiedSampler::jitter, "a random place in each cell instead of its centre");
        describe_seed(f);
        f.example("tall", {make_integer("xsamples", 2), make_integer("ysamples", 8)});
    }

    int samples_per_pixel() const override { return xsamples * ysamples; }

    SampleState start(Vec2i pixel, std::uint32_t sample) const override {
        return {pixel, sample, 0, mix_bits(seed_ ^ pixel_key(pixel))};
    }
    float next1(SampleState& state) const override {
        std::uint32_t cells = count();
        auto [cell, h] = place(state);
        state.dimension += 1;
        float offset = jitter ? unit_float(h) : 0.5f;
        return std::min((static_cast<float>(cell) + offset) / static_cast<float>(cells), one_minus_epsilon);
    }
    Vec2 next2(SampleState& state) const override {
        auto nx = static_cast<std::uint32_t>(xsamples), ny = static_cast<std::uint32_t>(ysamples);
        auto [cell, h] = place(state);
        state.dimension += 2;
        Vec2 offset = jitter ? unit_pair(h) : Vec2(0.5f, 0.5f);
        auto coordinate = [](std::uint32_t i, float o, std::uint32_t n) {
            return std::min((static_cast<float>(i) + o) / static_cast<float>(n), one_minus_epsilon);
        };
        return {coordinate(cell % nx, offset.x, nx), coordinate(cell / nx, offset.y, ny)};
    }
    void prepare(Vec2i resolution, int samples_per_pixel, std::uint64_t seed_of_render) override {
        CountedSampler::prepare(resolution, samples_per_pixel, seed_of_render);
        if (samples_per_pixel != xsamples * ysamples) divide(samples_per_pixel);
    }

    bool is_even(int samples) const override {
        const auto side = std::lround(std::sqrt(static_cast<double>(samples)));
        return side * side == samples;
    }
    std::unique_ptr<Sampler> for_count(int samples) const override {
        auto other = std::make_unique<StratifiedSampler>(*this);
        other->divide(samples);
        return other;
    }

  private:
    // The two factors nearest to its square root.
    void divide(int samples) {
        ysamples = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(samples))));
        while (samples % ysamples != 0) --ysamples;
        xsamples = samples / ysamples;
    }
    struct Place {
        std::uint32_t cell;
        std::uint64_t hash;
    };
    std::uint32_t count() const { return static_cast<std::uint32_t>(xsamples * ysamples); }
    // The sample's cell in its dimension, and a hash for the place in the cell. Samples beyond the declared
    // number start over with another order.
    Place place(const SampleState& state) const {
        std::uint32_t n = count();
        std::uint64_t key = sub_key(state.index, state.dimension + (std::uint64_t{state.sample / n} << 32));
        return {permuted_index(state.sample % n, n, key), sub_key(key, state.sample)};
    }
};

} // namespace

Kind<Sampler> stratified_sampler() {
    return make_kind<Sampler, StratifiedSampler>("stratified");
}

} // namespace alhazen
