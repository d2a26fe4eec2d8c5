/// Every light with the same probability.
#include "lights/light_chooser.h"
#include "lights/light_index.h"

namespace alhazen {
namespace {

class UniformChooser final : public LightChooser {
  public:
    explicit UniformChooser(std::span<const Light* const> lights)
        : lights_(lights.begin(), lights.end()), index_(lights) {}

    std::optional<ChosenLight> choose(const LightReceiver&, float u) const override {
        if (lights_.empty()) return std::nullopt;
        // In double, since a float times a large count may round up to the count.
        auto i = static_cast<std::size_t>(static_cast<double>(u) * static_cast<double>(lights_.size()));
        return ChosenLight{lights_[std::min(i, lights_.size() - 1)], 1 / static_cast<float>(lights_.size())};
    }
    float probability(const LightReceiver&, const Light* light) const override {
        return index_.find(light) ? 1 / static_cast<float>(lights_.size()) : 0;
    }

  private:
    std::vector<const Light*> lights_;
    LightIndex index_;
};

} // namespace

std::unique_ptr<LightChooser> uniform_light_chooser(std::span<const Light* const> lights) {
    return std::make_unique<UniformChooser>(lights);
}

} // namespace alhazen
