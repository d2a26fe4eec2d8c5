#include "textures/texture.h"

#include <fmt/format.h>

#include "describe/spectrum_parameter.h"
#include "textures/texture_set.h"

namespace alhazen {

namespace {

// The name that a texture parameter holds, or nullptr with an error added.
const std::string* texture_name(const Parameter& p, BuildContext& context) {
    const auto* names = std::get_if<std::vector<std::string>>(&p.values);
    if (names && names->size() == 1) return names->data();
    report_wrong_count(p, "one texture name", context);
    return nullptr;
}

void report_unknown_texture(const Parameter& p, const std::string& name, bool is_spectrum,
                            BuildContext& context) {
    std::string_view wanted = is_spectrum ? "spectrum" : "float";
    bool has_other = context.textures &&
                     (is_spectrum ? context.textures->has_float(name) : context.textures->has_spectrum(name));
    std::string hint;
    if (has_other)
        hint = fmt::format("; there is a {} texture of that name, but this must be a {} texture",
                           is_spectrum ? "float" : "spectrum", wanted);
    else if (context.textures)
        hint = did_you_mean(name, is_spectrum ? context.textures->spectrum_names()
                                              : context.textures->float_names());
    context.messages.add_error(p.place,
                               fmt::format("parameter \"{}\" refers to the {} texture \"{}\", which is not "
                                           "defined{}",
                                           p.name, wanted, name, hint));
}

} // namespace

void read_float_texture(FloatTexture& out, const Parameter& p, BuildContext& context) {
    if (p.type == ValueType::texture) {
        const std::string* name = texture_name(p, context);
        if (!name) return;
        if (context.textures && context.textures->has_float(*name)) {
            // One that has errors has told them already.
            if (auto node = context.textures->find_float(*name)) out = FloatTexture(std::move(node));
        } else {
            report_unknown_texture(p, *name, false, context);
        }
    } else if (p.type == ValueType::real || p.type == ValueType::integer) {
        float value = out.constant();
        FieldType<float>::read(value, p, context);
        out = FloatTexture(value);
    } else {
        report_wrong_type(p, FieldType<FloatTexture>::type_text(), context);
    }
}

void read_spectrum_texture(SpectrumTexture& out, const Parameter& p, SpectrumRole role,
                           BuildContext& context) {
    if (p.type != ValueType::texture) {
        if (p.type == ValueType::string || p.type == ValueType::boolean)
            report_wrong_type(p, FieldType<AlbedoTexture>::type_text(), context);
        else if (auto value = read_spectrum(p, role, context))
            out = SpectrumTexture(std::move(*value));
        return;
    }
    const std::string* name = texture_name(p, context);
    if (!name) return;
    if (!context.textures || !context.textures->has_spectrum(*name))
        report_unknown_texture(p, *name, true, context);
    else if (auto node = context.textures->find_spectrum(*name, role, &context.messages))
        out = SpectrumTexture(std::move(node));
}

} // namespace alhazen
