/// Choosing a light: which of the scene's lights to sample at a point, with what probability.
#pragma once

#include <memory>
#include <span>

#include "lights/light.h"

namespace alhazen {

struct ChosenLight {
    const Light* light = nullptr;
    float probability = 0;
};

struct LightChooser {
    virtual ~LightChooser() = default;
    /// A light for the receiver by u in [0, 1); nullopt when none can contribute.
    virtual std::optional<ChosenLight> choose(const LightReceiver& at, float u) const = 0;
    /// The probability with which choose() returns this light.
    virtual float probability(const LightReceiver& at, const Light* light) const = 0;
};

/// name: "uniform", "power" or "bvh" (Conty Estevez and Kulla 2018). The lights must be prepared and outlive
/// the chooser. nullptr when the name is not one of light_chooser_names().
std::unique_ptr<LightChooser> make_light_chooser(std::string_view name, std::span<const Light* const> lights);
std::vector<std::string> light_chooser_names();

} // namespace alhazen
