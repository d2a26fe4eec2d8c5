#include "render/scene_options.h"

#include <fmt/format.h>

namespace alhazen {

SceneOptionValues read_scene_options(const SceneDescription& scene, Messages& messages) {
    SceneOptionValues values;
    for (const Node& option : scene.options) {
        if (option.parameters.empty()) continue;
        const Parameter& value = option.parameters.front();
        const auto* flags = std::get_if<std::vector<std::uint8_t>>(&value.values);
        const bool is_set = flags && !flags->empty() && flags->front();
        if (option.type == "disablepixeljitter") values.disablepixeljitter = is_set;
        if (option.type == "disablewavelengthjitter") values.disablewavelengthjitter = is_set;
        if (option.type == "disabletexturefiltering") values.disabletexturefiltering = is_set;
        if (option.type == "forcediffuse") values.forcediffuse = is_set;
        if (option.type == "displacementedgescale") {
            const auto* number = std::get_if<std::vector<float>>(&value.values);
            if (number && number->size() == 1 && number->front() > 0 && std::isfinite(number->front()))
                values.displacementedgescale = number->front();
            else
                messages.add_error(option.place, "option \"displacementedgescale\" must be above 0");
        }
        if (option.type.starts_with("msereference"))
            messages.add_warning(
                option.place,
                fmt::format("option \"{}\" has no effect; alhazen diff compares pictures", option.type));
    }
    return values;
}

} // namespace alhazen
