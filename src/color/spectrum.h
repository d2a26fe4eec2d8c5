/// Four numbers at once: the value that light, textures and BSDFs carry along a path.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>

namespace alhazen {

/// Four float lanes in one SIMD register. In spectral mode they are four sampled wavelengths; in RGB mode
/// red, green, blue and a spare lane that holds the mean of the three. Integrators and BSDFs see lanes only.
struct Spectrum {
    using Lanes = float __attribute__((vector_size(16)));
    Lanes lanes{};

    Spectrum() = default;
    /// The same value in each lane; implicit, since a number is a grey spectrum.
    Spectrum(float s) : lanes{s, s, s, s} {}
    Spectrum(float a, float b, float c, float d) : lanes{a, b, c, d} {}
    explicit Spectrum(Lanes l) : lanes(l) {}

    float operator[](int i) const { return lanes[i]; }
    void set(int i, float v) { lanes[i] = v; }

    friend Spectrum operator+(Spectrum a, Spectrum b) { return Spectrum(a.lanes + b.lanes); }
    friend Spectrum operator-(Spectrum a, Spectrum b) { return Spectrum(a.lanes - b.lanes); }
    friend Spectrum operator*(Spectrum a, Spectrum b) { return Spectrum(a.lanes * b.lanes); }
    friend Spectrum operator/(Spectrum a, Spectrum b) { return Spectrum(a.lanes / b.lanes); }
    friend Spectrum operator-(Spectrum a) { return Spectrum(-a.lanes); }
    Spectrum& operator+=(Spectrum b) { return *this = *this + b; }
    Spectrum& operator-=(Spectrum b) { return *this = *this - b; }
    Spectrum& operator*=(Spectrum b) { return *this = *this * b; }
    Spectrum& operator/=(Spectrum b) { return *this = *this / b; }
    bool operator==(const Spectrum& b) const { return is_none(lanes != b.lanes); }

    float sum() const { return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]); }
    float average() const { return 0.25f * sum(); }
    float max() const { return std::max(std::max(lanes[0], lanes[1]), std::max(lanes[2], lanes[3])); }
    float min() const { return std::min(std::min(lanes[0], lanes[1]), std::min(lanes[2], lanes[3])); }
    /// True when every lane is zero.
    bool is_black() const { return is_none(lanes != 0); }
    bool is_finite() const { return is_none(lanes - lanes != 0); }

  private:
    // Whether a comparison holds in no lane; half of them at a time.
    template <class Comparison>
    static bool is_none(Comparison lanes) {
        using Halves = long long __attribute__((vector_size(16)));
        const auto halves = std::bit_cast<Halves>(lanes);
        return (halves[0] | halves[1]) == 0;
    }
};

/// f applied to each lane.
template <class F>
Spectrum map(Spectrum s, F f) {
    return {f(s[0]), f(s[1]), f(s[2]), f(s[3])};
}
inline Spectrum sqrt(Spectrum s) {
    return map(s, [](float v) { return std::sqrt(v); });
}
inline Spectrum exp(Spectrum s) {
    return map(s, [](float v) { return std::exp(v); });
}
inline Spectrum clamp(Spectrum s, float lo, float hi) {
    return map(s, [=](float v) { return std::clamp(v, lo, hi); });
}
/// a / b lane by lane, 0 where b is 0.
inline Spectrum safe_divide(Spectrum a, Spectrum b) {
    auto lane = [&](int i) { return b[i] != 0 ? a[i] / b[i] : 0.0f; };
    return {lane(0), lane(1), lane(2), lane(3)};
}
inline Spectrum lerp(float t, Spectrum a, Spectrum b) {
    return a * (1 - t) + b * t;
}

} // namespace alhazen
