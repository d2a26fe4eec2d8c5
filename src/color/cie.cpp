/// The CIE 1931 observer and daylight by colour temperature.
#include <algorithm>
#include <array>
#include <cmath>

#include "color/spectral.h"

namespace alhazen {

namespace {

constexpr std::size_t wavelength_count = 471;
constexpr float observer[wavelength_count * 3] = {
#include "color/data/cie_1931.inl"
};

constexpr std::size_t daylight_count = 48;
constexpr float daylight_components[daylight_count * 3] = {
#include "color/data/daylight.inl"
};

SpectralCurve observer_curve(std::size_t component) {
    std::vector<float> values;
    for (std::size_t i = 0; i < wavelength_count; ++i) values.push_back(observer[3 * i + component]);
    return SpectralCurve::uniform(lambda_min, 1, std::move(values));
}

/// Chromaticity of daylight (CIE 15:2004, equations 3.2 to 3.4).
Vec2d daylight_chromaticity(double cct) {
    double t = 1e3 / cct;
    double x = cct <= 7000 ? ((-4.6070 * t + 2.9678) * t + 0.09911) * t + 0.244063
                           : ((-2.0064 * t + 1.9018) * t + 0.24748) * t + 0.237040;
    return {x, (-3 * x + 2.870) * x - 0.275};
}

} // namespace

const SpectralCurve& cie_x() {
    static const SpectralCurve curve = observer_curve(0);
    return curve;
}
const SpectralCurve& cie_y() {
    static const SpectralCurve curve = observer_curve(1);
    return curve;
}
const SpectralCurve& cie_z() {
    static const SpectralCurve curve = observer_curve(2);
    return curve;
}

ObserverSample sample_observer(Spectrum lambda) {
    ObserverSample sample;
    for (int lane = 0; lane < 4; ++lane) {
        float x = lambda[lane] - lambda_min;
        if (!(x >= 0 && x <= static_cast<float>(wavelength_count - 1))) continue;
        std::size_t i = std::min(static_cast<std::size_t>(x), wavelength_count - 2);
        float t = x - static_cast<float>(i);
        const float* row = observer + 3 * i;
        sample.x.set(lane, lerp(t, row[0], row[3]));
        sample.y.set(lane, lerp(t, row[1], row[4]));
        sample.z.set(lane, lerp(t, row[2], row[5]));
    }
    return sample;
}

Vec3d cie_integrals(const SpectralCurve& curve) {
    Vec3d sum;
    for (std::size_t i = 0; i < wavelength_count; ++i) {
        double value = curve.eval(lambda_min + static_cast<float>(i));
        sum += Vec3d(observer[3 * i], observer[3 * i + 1], observer[3 * i + 2]) * value;
    }
    return sum;
}

double y_integral(const SpectralCurve& curve) {
    return cie_integrals(curve).y;
}

SpectralCurve SpectralCurve::daylight(float kelvin) {
    // The temperature scale has changed since the formula was made: c2 was 1.4380e-2 m K, now 1.4388e-2.
    double cct = kelvin * 1.4388 / 1.4380;
    SpectralCurve curve = constant(0);
    if (cct < 4000) {
        curve = blackbody(static_cast<float>(cct));
    } else {
        auto [x, y] = daylight_chromaticity(cct);
        double m = 0.0241 + 0.2562 * x - 0.7341 * y;
        double m1 = (-1.3515 - 1.7703 * x + 5.9114 * y) / m;
        double m2 = (0.0300 - 31.4424 * x + 30.0717 * y) / m;
        std::vector<float> values;
        for (std::size_t i = 0; i < daylight_count; ++i) {
            const float* s = daylight_components + 3 * i;
            values.push_back(static_cast<float>(s[0] + m1 * s[1] + m2 * s[2]));
        }
        curve = uniform(lambda_min, 10, std::move(values));
    }
    double y = y_integral(curve);
    return y > 0 ? curve.scaled(static_cast<float>(cie_y_integral / y)) : curve;
}

} // namespace alhazen
