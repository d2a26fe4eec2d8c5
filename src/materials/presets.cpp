#include "materials/presets.h"

#include <fmt/format.h>

namespace alhazen {

namespace {

struct Named {
    const char* name;
    MediumPreset preset;
};

// Jensen, Marschner, Levoy and Hanrahan 2001, "A practical model for subsurface light transport"; and
// Narasimhan, Gupta, Donner, Ramamoorthi, Nayar and Jensen 2006, "Acquiring scattering properties of
// participating media by dilution".
constexpr Named presets[] = {
#include "materials/data/presets.inl"
};

} // namespace

std::optional<MediumPreset> find_medium_preset(const Parameter& p, const std::string& name,
                                               BuildContext& context) {
    std::vector<std::string> known;
    for (const Named& named : presets) {
        if (name == named.name) return named.preset;
        known.emplace_back(named.name);
    }
    context.messages.add_error(
        p.place, fmt::format("no measured matter is named \"{}\"{}", name, did_you_mean(name, known)));
    return std::nullopt;
}

} // namespace alhazen
