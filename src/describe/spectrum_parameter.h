/// Colours in parameters: rgb, blackbody, spectra by name, by file, or as samples in line.
#pragma once

#include <memory>

#include "color/spectrum_value.h"
#include "describe/field_types.h"

namespace alhazen {

/// The colour that p gives, with rgb values meaning what role says; nullopt with an error added when p does
/// not give one. A float or integer is a constant spectrum.
std::optional<SpectrumValue> read_spectrum(const Parameter& p, SpectrumRole role, BuildContext& context);

/// A SpectrumValue member together with what its rgb values mean.
template <SpectrumRole role>
struct RoleSpectrum {
    SpectrumValue value = SpectrumValue::constant(1);
    std::string text = "1"; ///< how the manual prints it as a default

    RoleSpectrum() = default;
    RoleSpectrum(float grey)
        : value(SpectrumValue::constant(grey)), text(number_text(static_cast<double>(grey))) {}
    RoleSpectrum(SpectrumValue v, std::string text_) : value(std::move(v)), text(std::move(text_)) {}
    Spectrum eval(const Wavelengths& lambda) const { return value.eval(lambda); }
};
using AlbedoSpectrum = RoleSpectrum<SpectrumRole::albedo>;
using UnboundedSpectrum = RoleSpectrum<SpectrumRole::unbounded>;
using IlluminantSpectrum = RoleSpectrum<SpectrumRole::illuminant>;

template <SpectrumRole role>
struct FieldType<RoleSpectrum<role>> {
    static std::string type_text() { return "rgb | spectrum | blackbody | float"; }
    static std::string default_text(const RoleSpectrum<role>& v) { return v.text; }
    static void read(RoleSpectrum<role>& out, const Parameter& p, BuildContext& context) {
        if (auto value = read_spectrum(p, role, context)) out = {std::move(*value), ""};
    }
};

} // namespace alhazen
