#include "describe/spectrum_parameter.h"

#include <stdexcept>

#include <fmt/format.h>

#include "base/file.h"

namespace alhazen {

namespace {

using Result = std::optional<SpectrumValue>;

Result fail(const Parameter& p, std::string text, BuildContext& context) {
    context.messages.add_error(p.place, fmt::format("parameter \"{}\" {}", p.name, text));
    return std::nullopt;
}

Result read_rgb(const Parameter& p, const std::vector<float>& v, SpectrumRole role, BuildContext& context) {
    if (v.size() != 3) {
        report_wrong_count(p, "three values: red, green, blue", context);
        return std::nullopt;
    }
    for (float c : v) {
        if (c < 0)
            return fail(p, fmt::format("has the component {}; an rgb colour must not be negative", c),
                        context);
        if (role == SpectrumRole::albedo && c > 1)
            return fail(p, fmt::format("has the component {}; a reflectance must be 0 to 1", c), context);
    }
    const RgbColorSpace* space = find_color_space(p.color_space);
    if (!space)
        return fail(p,
                    fmt::format("is in the colour space \"{}\", which is not known{}", p.color_space,
                                did_you_mean(p.color_space, color_space_names())),
                    context);
    return SpectrumValue::rgb(*space, {v[0], v[1], v[2]}, role);
}

Result read_blackbody(const Parameter& p, const std::vector<float>& v, SpectrumRole role,
                      BuildContext& context) {
    if (v.size() != 1) {
        report_wrong_count(p, "one temperature in kelvin", context);
        return std::nullopt;
    }
    if (!(v[0] > 0))
        return fail(p, fmt::format("is {} K; a black body's temperature must be above 0", v[0]), context);
    return SpectrumValue::blackbody(v[0], role);
}

// A spectrum's name, or else the name of a file of wavelengths and values.
Result read_named(const Parameter& p, const std::vector<std::string>& v, SpectrumRole role,
                  BuildContext& context) {
    if (v.size() != 1) {
        report_wrong_count(p, "one name", context);
        return std::nullopt;
    }
    if (const SpectralCurve* curve = named_spectrum(v[0])) return SpectrumValue::curve(*curve, role);
    std::filesystem::path path = context.resolve(v[0]);
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored))
        return fail(p,
                    fmt::format("is \"{}\", which is neither a known spectrum nor a file{}", v[0],
                                did_you_mean(v[0], spectrum_names())),
                    context);
    try {
        constexpr std::size_t max_bytes = std::size_t{64} << 20;
        auto curve = std::make_shared<SpectralCurve>(SpectralCurve::parse(read_file(path, max_bytes)));
        return SpectrumValue::curve(std::move(curve), role);
    } catch (const std::exception& e) {
        return fail(p, fmt::format("names the spectrum file \"{}\": {}", path.string(), e.what()), context);
    }
}

Result read_samples(const Parameter& p, const std::vector<float>& v, SpectrumRole role,
                    BuildContext& context) {
    try {
        return SpectrumValue::curve(std::make_shared<SpectralCurve>(SpectralCurve::from_pairs(v)), role);
    } catch (const std::exception& e) {
        return fail(p, fmt::format("is not a spectrum: {}", e.what()), context);
    }
}

Result read_constant(const Parameter& p, SpectrumRole role, BuildContext& context) {
    std::size_t errors = context.messages.error_count();
    float value = 0;
    FieldType<float>::read(value, p, context);
    if (context.messages.error_count() != errors) return std::nullopt;
    if (value < 0) return fail(p, fmt::format("is {}; a colour must not be negative", value), context);
    return SpectrumValue::constant(value, role);
}

} // namespace

std::optional<SpectrumValue> read_spectrum(const Parameter& p, SpectrumRole role, BuildContext& context) {
    const auto* numbers = std::get_if<std::vector<float>>(&p.values);
    const auto* names = std::get_if<std::vector<std::string>>(&p.values);
    if (numbers)
        for (float v : *numbers)
            if (!std::isfinite(v))
                return fail(p, fmt::format("is {}; it must be a finite number", v), context);
    switch (p.type) {
    case ValueType::rgb:
        if (numbers) return read_rgb(p, *numbers, role, context);
        break;
    case ValueType::blackbody:
        if (numbers) return read_blackbody(p, *numbers, role, context);
        break;
    case ValueType::spectrum:
        if (numbers) return read_samples(p, *numbers, role, context);
        if (names) return read_named(p, *names, role, context);
        break;
    case ValueType::real:
    case ValueType::integer:
        return read_constant(p, role, context);
    default:
        break;
    }
    report_wrong_type(p, FieldType<RoleSpectrum<SpectrumRole::albedo>>::type_text(), context);
    return std::nullopt;
}

} // namespace alhazen
