/// Matter that was measured, by name.
#pragma once

#include <optional>
#include <string>

#include "base/vec.h"
#include "describe/context.h"
#include "describe/value.h"

namespace alhazen {

/// Per mm, for red, green and blue. The scattering is the reduced one, to be used with isotropic scattering.
struct MediumPreset {
    Vec3 sigma_s, sigma_a;
};

/// nullopt with an error added, at p's place, when there is none of that name.
std::optional<MediumPreset> find_medium_preset(const Parameter& p, const std::string& name,
                                               BuildContext& context);

} // namespace alhazen
