/// Curves through samples: evaluation, and how they are built from numbers, text and Planck's law.
#include "color/spectral.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace alhazen {

namespace {

void check_samples(std::span<const float> lambdas, std::span<const float> values) {
    if (lambdas.size() != values.size())
        throw std::invalid_argument(
            fmt::format("{} wavelengths but {} values; expected one value for each wavelength",
                        lambdas.size(), values.size()));
    if (lambdas.size() < 2)
        throw std::invalid_argument(
            fmt::format("a spectrum of {} samples; expected at least 2", lambdas.size()));
    for (std::size_t i = 0; i < lambdas.size(); ++i) {
        if (!std::isfinite(lambdas[i]) || !std::isfinite(values[i]))
            throw std::invalid_argument(
                fmt::format("sample {} of the spectrum is not a finite number", i + 1));
        if (!(lambdas[i] > 0))
            throw std::invalid_argument(
                fmt::format("wavelength {} nm; expected a positive number", lambdas[i]));
        if (i > 0 && !(lambdas[i] > lambdas[i - 1]))
            throw std::invalid_argument(
                fmt::format("wavelength {} nm follows {} nm; expected increasing wavelengths", lambdas[i],
                            lambdas[i - 1]));
    }
}

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}

/// std::from_chars for floats is missing in clang's standard library, and strtof depends on the locale.
float parse_number(const std::string& word) {
    try {
        std::size_t used = 0;
        double value = std::stod(word, &used);
        if (used == word.size()) return static_cast<float>(value);
    } catch (const std::logic_error&) {
        // Said below.
    }
    throw std::invalid_argument(fmt::format("\"{}\"; expected a number", word.substr(0, 40)));
}

} // namespace

void SpectralCurve::find_max() {
    max_ = *std::max_element(values_.begin(), values_.end());
}

SpectralCurve SpectralCurve::constant(float value) {
    SpectralCurve curve;
    curve.values_ = {value};
    curve.constant_ = true;
    curve.max_ = value;
    return curve;
}

SpectralCurve SpectralCurve::from_samples(std::span<const float> lambdas, std::span<const float> values) {
    check_samples(lambdas, values);
    float step = (lambdas.back() - lambdas.front()) / static_cast<float>(lambdas.size() - 1);
    bool even = true;
    for (std::size_t i = 0; i < lambdas.size(); ++i)
        even = even && lambdas[i] == lambdas.front() + step * static_cast<float>(i);
    std::vector<float> copy(values.begin(), values.end());
    if (even) return uniform(lambdas.front(), step, std::move(copy));
    SpectralCurve curve;
    curve.lambdas_.assign(lambdas.begin(), lambdas.end());
    curve.values_ = std::move(copy);
    curve.find_max();
    return curve;
}

SpectralCurve SpectralCurve::from_pairs(std::span<const float> pairs) {
    if (pairs.size() % 2 != 0)
        throw std::invalid_argument(
            fmt::format("{} numbers; expected pairs of a wavelength and a value", pairs.size()));
    std::vector<float> lambdas, values;
    for (std::size_t i = 0; i < pairs.size(); i += 2) {
        lambdas.push_back(pairs[i]);
        values.push_back(pairs[i + 1]);
    }
    return from_samples(lambdas, values);
}

SpectralCurve SpectralCurve::parse(std::string_view text) {
    std::vector<float> numbers;
    for (std::size_t i = 0; i < text.size();) {
        if (is_blank(text[i])) {
            ++i;
        } else if (text[i] == '#') {
            i = std::min(text.find('\n', i), text.size());
        } else {
            std::size_t end = i;
            while (end < text.size() && !is_blank(text[end]) && text[end] != '#') ++end;
            numbers.push_back(parse_number(std::string(text.substr(i, end - i))));
            i = end;
        }
    }
    return from_pairs(numbers);
}

SpectralCurve SpectralCurve::uniform(float start, float step, std::vector<float> values) {
    SpectralCurve curve;
    curve.start_ = start;
    curve.inverse_step_ = 1 / step;
    curve.values_ = std::move(values);
    curve.find_max();
    return curve;
}

float SpectralCurve::eval(float lambda) const {
    if (constant_) return values_[0];
    if (lambdas_.empty()) {
        float x = (lambda - start_) * inverse_step_;
        auto last = values_.size() - 1;
        if (!(x >= 0 && x <= static_cast<float>(last))) return 0;
        std::size_t i = std::min(static_cast<std::size_t>(x), last - 1);
        return lerp(x - static_cast<float>(i), values_[i], values_[i + 1]);
    }
    if (!(lambda >= lambdas_.front() && lambda <= lambdas_.back())) return 0;
    auto above = std::upper_bound(lambdas_.begin() + 1, lambdas_.end() - 1, lambda);
    auto i = static_cast<std::size_t>(above - lambdas_.begin()) - 1;
    float t = (lambda - lambdas_[i]) / (lambdas_[i + 1] - lambdas_[i]);
    return lerp(t, values_[i], values_[i + 1]);
}

Spectrum SpectralCurve::eval(Spectrum lambdas) const {
    if (constant_) return values_[0];
    return map(lambdas, [this](float lambda) { return eval(lambda); });
}

SpectralCurve SpectralCurve::scaled(float s) const {
    SpectralCurve curve = *this;
    for (float& v : curve.values_) v *= s;
    curve.find_max();
    return curve;
}

SpectralCurve SpectralCurve::extended() const {
    if (constant_) return *this;
    std::vector<float> lambdas = lambdas_, values = values_;
    if (lambdas.empty()) {
        for (std::size_t i = 0; i < values.size(); ++i)
            lambdas.push_back(start_ + static_cast<float>(i) / inverse_step_);
    }
    if (lambdas.front() > lambda_min) {
        lambdas.insert(lambdas.begin(), lambda_min);
        values.insert(values.begin(), values.front());
    }
    if (lambdas.back() < lambda_max) {
        lambdas.push_back(lambda_max);
        values.push_back(values.back());
    }
    return from_samples(lambdas, values);
}

double blackbody_radiance(double lambda, double kelvin) {
    if (!(kelvin > 0)) return 0;
    // CODATA 2010, as in pbrt-v4.
    constexpr double light_speed = 299792458, planck = 6.62606957e-34, boltzmann = 1.3806488e-23;
    double metres = lambda * 1e-9;
    double exponential = std::expm1(planck * light_speed / (metres * boltzmann * kelvin));
    return 2 * planck * light_speed * light_speed / (std::pow(metres, 5) * exponential);
}

SpectralCurve SpectralCurve::blackbody(float kelvin) {
    constexpr double wien = 2.8977721e6; // nm K
    double peak = blackbody_radiance(wien / kelvin, kelvin);
    std::vector<float> values;
    for (float lambda = lambda_min; lambda <= lambda_max; ++lambda) {
        double relative = peak > 0 ? blackbody_radiance(lambda, kelvin) / peak : 0;
        values.push_back(std::isfinite(relative) ? static_cast<float>(relative) : 0);
    }
    return uniform(lambda_min, 1, std::move(values));
}

} // namespace alhazen
