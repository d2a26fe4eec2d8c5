#include "color/spectrum_value.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

namespace {

/// Surfaces and indices are brought into the gamut; light need not be, as lanes of light are only ever added
/// up and multiplied by what is positive.
Spectrum rgb_lanes(Vec3 srgb, SpectrumRole role) {
    if (role != SpectrumRole::illuminant) srgb = max(srgb, Vec3(0));
    return {srgb.x, srgb.y, srgb.z, (srgb.x + srgb.y + srgb.z) / 3};
}

/// Linear sRGB of rgb in a space.
Vec3 to_srgb(const RgbColorSpace& space, Vec3 rgb) {
    return convert_rgb(space, srgb_space()) * rgb;
}

/// Linear sRGB of what a surface of this reflectance shows under D65.
Vec3 color_under_d65(const SpectralCurve& curve) {
    if (curve.is_constant()) return Vec3(curve.eval(lambda_min));
    const SpectralCurve& white = *srgb_space().illuminant;
    Vec3d xyz;
    double y = 0;
    for (float lambda = lambda_min; lambda <= lambda_max; ++lambda) {
        Vec3d observed = Vec3d(cie_x().eval(lambda), cie_y().eval(lambda), cie_z().eval(lambda)) *
                         static_cast<double>(white.eval(lambda));
        xyz += observed * static_cast<double>(curve.eval(lambda));
        y += observed.y;
    }
    return Vec3(srgb_space().rgb_from_xyz * (xyz / y));
}

/// Linear sRGB of light with this spectrum.
Vec3 color_of_light(const SpectralCurve& curve) {
    return Vec3(srgb_space().rgb_from_xyz * (cie_integrals(curve) / static_cast<double>(cie_y_integral)));
}

double y_integral_of(const SigmoidCoefficients& sigmoid) {
    double sum = 0;
    for (float lambda = lambda_min; lambda <= lambda_max; ++lambda)
        sum += static_cast<double>(cie_y().eval(lambda)) * static_cast<double>(sigmoid.eval(lambda));
    return sum;
}

} // namespace

SpectrumValue SpectrumValue::constant(float value, SpectrumRole role) {
    SpectrumValue v;
    v.role_ = role;
    v.scale_ = value;
    v.rgb_lanes_ = value;
    if (role == SpectrumRole::illuminant) {
        static const Vec3 equal_energy = color_of_light(SpectralCurve::constant(1));
        v.rgb_lanes_ = rgb_lanes(equal_energy * value, role);
    }
    return v;
}

SpectrumValue SpectrumValue::albedo_rgb(const RgbColorSpace& space, Vec3 rgb) {
    rgb = min(max(rgb, Vec3(0)), Vec3(1));
    if (rgb == Vec3(rgb.x)) return constant(rgb.x, SpectrumRole::albedo);
    SpectrumValue v;
    v.kind_ = Kind::sigmoid;
    v.role_ = SpectrumRole::albedo;
    v.scale_ = 1;
    v.sigmoid_ = upsample(space, rgb);
    v.rgb_lanes_ = rgb_lanes(to_srgb(space, rgb), v.role_);
    return v;
}

SpectrumValue SpectrumValue::unbounded_rgb(const RgbColorSpace& space, Vec3 rgb) {
    rgb = max(rgb, Vec3(0));
    float m = max_component(rgb);
    if (rgb == Vec3(rgb.x)) return constant(rgb.x, SpectrumRole::unbounded);
    SpectrumValue v;
    v.kind_ = Kind::sigmoid;
    v.role_ = SpectrumRole::unbounded;
    // At half of the range, where spectra are smooth (Pharr et al. 2023, section 4.6.6).
    v.scale_ = 2 * m;
    v.sigmoid_ = upsample(space, rgb / v.scale_);
    v.rgb_lanes_ = rgb_lanes(to_srgb(space, rgb), v.role_);
    return v;
}

SpectrumValue SpectrumValue::illuminant_rgb(const RgbColorSpace& space, Vec3 rgb) {
    rgb = max(rgb, Vec3(0));
    float m = max_component(rgb);
    SpectrumValue v;
    v.kind_ = Kind::illuminant;
    v.role_ = SpectrumRole::illuminant;
    v.scale_ = 2 * m;
    v.sigmoid_ = m > 0 ? upsample(space, rgb / v.scale_) : SigmoidCoefficients::grey(0);
    v.rgb_lanes_ = rgb_lanes(to_srgb(space, rgb), v.role_);
    // Named spectra live as long as the program: no owner.
    v.curve_ = std::shared_ptr<const SpectralCurve>(std::shared_ptr<void>(), space.illuminant);
    return v;
}

SpectrumValue SpectrumValue::rgb(const RgbColorSpace& space, Vec3 rgb, SpectrumRole role) {
    switch (role) {
    case SpectrumRole::albedo:
        return albedo_rgb(space, rgb);
    case SpectrumRole::unbounded:
        return unbounded_rgb(space, rgb);
    case SpectrumRole::illuminant:
        return illuminant_rgb(space, rgb);
    }
    return {};
}

SpectrumValue SpectrumValue::curve(std::shared_ptr<const SpectralCurve> curve, SpectrumRole role) {
    if (curve->is_constant()) return constant(curve->eval(lambda_min), role);
    SpectrumValue v;
    v.kind_ = Kind::curve;
    v.role_ = role;
    v.scale_ = curve->max_value() > 0 ? 1.0f : 0.0f;
    v.rgb_lanes_ =
        rgb_lanes(role == SpectrumRole::illuminant ? color_of_light(*curve) : color_under_d65(*curve), role);
    v.curve_ = std::move(curve);
    return v;
}

SpectrumValue SpectrumValue::curve(const SpectralCurve& curve, SpectrumRole role) {
    return SpectrumValue::curve(std::shared_ptr<const SpectralCurve>(std::shared_ptr<void>(), &curve), role);
}

SpectrumValue SpectrumValue::blackbody(float kelvin, SpectrumRole role) {
    return curve(std::make_shared<const SpectralCurve>(SpectralCurve::blackbody(kelvin)), role);
}

Spectrum SpectrumValue::eval_spectral(Spectrum lambda) const {
    switch (kind_) {
    case Kind::constant:
        return 1;
    case Kind::sigmoid:
        return sigmoid_.eval(lambda);
    case Kind::illuminant:
        return sigmoid_.eval(lambda) * curve_->eval(lambda);
    case Kind::curve:
        return curve_->eval(lambda);
    }
    return 0;
}

float SpectrumValue::max_value() const {
    float spectral = scale_;
    if (kind_ == Kind::sigmoid || kind_ == Kind::illuminant) spectral *= sigmoid_.max_value();
    if (kind_ == Kind::curve || kind_ == Kind::illuminant) spectral *= curve_->max_value();
    return std::max(spectral, rgb_lanes_.max());
}

SpectrumValue SpectrumValue::scaled(float s) const {
    SpectrumValue v = *this;
    v.scale_ *= s;
    v.rgb_lanes_ *= s;
    return v;
}

float SpectrumValue::photometric() const {
    switch (kind_) {
    case Kind::constant:
        return scale_ * cie_y_integral;
    case Kind::sigmoid:
        return scale_ * static_cast<float>(y_integral_of(sigmoid_));
    case Kind::illuminant:
        return static_cast<float>(y_integral(*curve_));
    case Kind::curve:
        return scale_ * static_cast<float>(y_integral(*curve_));
    }
    return 0;
}

float SpectrumValue::light_scale(ColorMode mode) const {
    float y = photometric();
    if (!(y > 0)) return 0;
    return mode == ColorMode::spectral ? 1 / y : cie_y_integral / y;
}

} // namespace alhazen
