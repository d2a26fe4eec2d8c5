/// Samplers: the numbers in [0, 1) that choose everything. Each is a pure function of (seed, pixel, sample,
/// dimension), so that no schedule changes the image.
#pragma once

#include <bit>
#include <memory>

#include "describe/kind.h"

namespace alhazen {

/// Where in the sequence a path is.
struct SampleState {
    Vec2i pixel;
    std::uint32_t sample = 0;
    std::uint32_t dimension = 0;
    std::uint64_t index = 0; ///< the sampler's own (index into the sequence)
};

struct Sampler {
    static constexpr std::string_view family_name = "sampler";
    virtual ~Sampler() = default;

    /// The first state of a sample. A pixel's samples are 0 ... samples_per_pixel() - 1; asking for more is
    /// allowed and stays well-defined.
    virtual SampleState start(Vec2i pixel, std::uint32_t sample) const = 0;
    /// The next number, advancing state.dimension by one.
    virtual float next1(SampleState& state) const = 0;
    /// The next pair, advancing state.dimension by two.
    virtual Vec2 next2(SampleState& state) const = 0;
    /// The pair for the place in the pixel: the best-distributed one. Taken first, once.
    virtual Vec2 pixel2(SampleState& state) const { return next2(state); }

    /// Whether that many samples of a pixel are spread as evenly as the kind can.
    virtual bool is_even(int samples) const { return std::has_single_bit(static_cast<unsigned>(samples)); }
    /// The sampler for another number of samples, where it depends on the number which places they have;
    /// nullptr where few are the first of many.
    virtual std::unique_ptr<Sampler> for_count(int /*samples*/) const { return nullptr; }

    /// As declared, rounded as the kind needs (powers of two, strata).
    virtual int samples_per_pixel() const = 0;
    /// Before rendering: the full film resolution, the number of samples wanted, the seed.
    virtual void prepare(Vec2i resolution, int samples_per_pixel, std::uint64_t seed) = 0;
};

const KindList<Sampler>& sampler_kinds();

/// A path's own cursor.
class SampleStream {
  public:
    SampleStream(const Sampler& sampler, Vec2i pixel, std::uint32_t sample)
        : sampler_(&sampler), state_(sampler.start(pixel, sample)) {}

    float next1() { return sampler_->next1(state_); }
    Vec2 next2() { return sampler_->next2(state_); }
    Vec2 pixel2() { return sampler_->pixel2(state_); }
    /// Leaves out so many numbers that nobody needs: those behind them stay what they are.
    void skip(std::uint32_t numbers) { state_.dimension += numbers; }
    const SampleState& state() const { return state_; }

  private:
    const Sampler* sampler_;
    SampleState state_;
};

} // namespace alhazen
