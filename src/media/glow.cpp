#include "media/glow.h"

#include "color/spectrum_value.h"

namespace alhazen {

namespace {

constexpr float hottest = 40000; // beyond, the colour hardly changes any more
constexpr int entries = 256;
// Wien: the maximum is at this wavelength in nm over the temperature.
constexpr double wien = 2.8977721e6;

float temperature(int entry) {
    return Glow::coldest * std::pow(hottest / Glow::coldest, static_cast<float>(entry) / (entries - 1));
}

} // namespace

Glow::Glow(ColorMode mode) {
    if (mode != ColorMode::rgb) return;
    for (int i = 0; i < entries; ++i)
        rgb_.push_back(SpectrumValue::blackbody(temperature(i)).eval(Wavelengths::rgb()) * cie_y_integral);
}

Spectrum Glow::eval(float kelvin, const Wavelengths& lambda) const {
    if (!(kelvin >= coldest)) return 0;
    if (lambda.mode == ColorMode::rgb) {
        const float at =
            std::log(std::min(kelvin, hottest) / coldest) / std::log(hottest / coldest) * (entries - 1);
        const auto i = std::min(static_cast<std::size_t>(at), rgb_.size() - 2);
        return lerp(at - static_cast<float>(i), rgb_[i], rgb_[i + 1]);
    }
    const auto k = static_cast<double>(kelvin);
    const double most = blackbody_radiance(wien / k, k);
    return map(lambda.lambda, [&](float l) {
        return static_cast<float>(blackbody_radiance(static_cast<double>(l), k) / most);
    });
}

} // namespace alhazen
