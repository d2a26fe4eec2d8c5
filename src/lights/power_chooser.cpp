/// Every light with a probability in proportion to its power.
#include "lights/light_chooser.h"
#include "lights/light_index.h"
#include "math/distribution.h"

namespace alhazen {
namespace {

/// Power as seen in RGB, whose lanes are whole spectra integrated: no narrow line can fall between the
/// wavelengths.
std::vector<float> weights_of(std::span<const Light* const> lights) {
    std::vector<float> weights;
    double sum = 0;
    for (const Light* light : lights) {
        float power = light->power(Wavelengths::rgb()).max();
        weights.push_back(std::isfinite(power) ? std::max(power, 0.0f) : 0.0f);
        sum += static_cast<double>(weights.back());
    }
    // No light is left without a chance: the power of a distant light in a scene without extent, for example,
    // is zero, though what it gives is not.
    auto least =
        static_cast<float>(1e-4 * sum / static_cast<double>(std::max<std::size_t>(lights.size(), 1)));
    for (float& w : weights) w = std::max(w, least);
    return weights;
}

class PowerChooser final : public LightChooser {
  public:
    explicit PowerChooser(std::span<const Light* const> lights)
        : lights_(lights.begin(), lights.end()), index_(lights), table_(weights_of(lights)) {}

    std::optional<ChosenLight> choose(const LightReceiver&, float u) const override {
        if (table_.empty()) return std::nullopt;
        auto s = table_.sample(u);
        return ChosenLight{lights_[s.index], s.probability};
    }
    float probability(const LightReceiver&, const Light* light) const override {
        auto i = index_.find(light);
        return i ? table_.probability(*i) : 0;
    }

  private:
    std::vector<const Light*> lights_;
    LightIndex index_;
    AliasTable table_;
};

} // namespace

std::unique_ptr<LightChooser> power_light_chooser(std::span<const Light* const> lights) {
    return std::make_unique<PowerChooser>(lights);
}

} // namespace alhazen
