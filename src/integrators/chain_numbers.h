/// The random numbers of a Markov chain of paths (Kelemen et al. 2002, "A simple and robust mutation strategy
/// for the Metropolis light transport algorithm"). A path is the vector of numbers that made it; a small
/// change of the numbers gives a path nearby, whatever the scene is.
#pragma once

#include <cmath>

#include "base/hash.h"
#include "math/density.h"
#include "samplers/sampler.h"

namespace alhazen {

/// Numbers are worked out when they are asked for, as if all had been changed at each step. One path reads
/// them at a time: what a sampler may do without being changed, this one may not do for two.
class ChainNumbers final : public Sampler {
  public:
    /// first: the key of the first vector; steps: that of all changes.
    ChainNumbers(std::uint64_t first, std::uint64_t steps, float sigma)
        : fresh_key_(first), steps_(steps), sigma_(sigma) {}

    /// Proposes the next vector: with the given probability another one altogether, or one nearby.
    void propose(float large_step_probability) {
        ++time_;
        ++attempt_;
        is_large_ = decision(0) < large_step_probability;
    }
    void accept() {
        if (!is_large_) return;
        last_fresh_ = time_;
        fresh_key_ = step_key();
    }
    /// Takes the proposal back.
    void reject() {
        for (Number& x : numbers_)
            if (x.changed == time_) x = {x.before, x.changed_before, x.before, x.changed_before};
        --time_;
    }
    /// The number in [0, 1) that decides on the proposal.
    float acceptance() const { return decision(1); }

    SampleState start(Vec2i, std::uint32_t) const override { return {}; }
    float next1(SampleState& state) const override { return number(state.dimension++); }
    Vec2 next2(SampleState& state) const override {
        const float x = next1(state);
        return {x, next1(state)};
    }
    int samples_per_pixel() const override { return 1; }
    void prepare(Vec2i, int, std::uint64_t) override {}

  private:
    struct Number {
        float value = 0;
        std::int64_t changed = -1; ///< at which time; before all time: not yet made
        float before = 0;
        std::int64_t changed_before = -1;
    };

    std::uint64_t step_key() const { return hash_of(steps_, attempt_); }
    float decision(std::uint64_t which) const { return unit_float(hash_of(step_key(), ~which)); }
    static float fresh(std::uint64_t key, std::uint32_t dimension) {
        return unit_float(hash_of(key, dimension));
    }

    float number(std::uint32_t dimension) const {
        if (dimension >= numbers_.size()) numbers_.resize(dimension + 1);
        Number& x = numbers_[dimension];
        if (x.changed < last_fresh_) x = {fresh(fresh_key_, dimension), last_fresh_, 0, -1};
        if (x.changed == time_) return x.value;
        x.before = x.value;
        x.changed_before = x.changed;
        if (is_large_) {
            x.value = fresh(step_key(), dimension);
        } else {
            // As many small steps as there were since, at once: the variances add up.
            const float spread = sigma_ * std::sqrt(static_cast<float>(time_ - x.changed));
            const float moved = x.value + sample_normal(fresh(step_key(), dimension), 0, spread);
            x.value = std::min(moved - std::floor(moved), one_minus_epsilon);
        }
        x.changed = time_;
        return x.value;
    }

    mutable std::vector<Number> numbers_;
    std::uint64_t fresh_key_; ///< of the latest vector that was drawn afresh
    std::uint64_t steps_;
    float sigma_;
    std::int64_t time_ = 0, last_fresh_ = 0; ///< in accepted steps
    std::uint64_t attempt_ = 0;
    bool is_large_ = false;
};

} // namespace alhazen
