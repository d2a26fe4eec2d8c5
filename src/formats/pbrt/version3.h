/// Words of pbrt-v3 (and of v2) that pbrt-v4 has renamed or dropped, so that an old scene is told what to
/// write instead.
#pragma once

#include <string>
#include <string_view>

#include "base/messages.h"

namespace alhazen {

struct OldName {
    std::string_view family; ///< "directive", "parameter type", "material", ... ; "parameter" for parameters
    std::string_view kind;   ///< of a parameter: the family it belongs to, "" for every family
    std::string_view name;
    std::string_view now;  ///< the name in v4; "" when there is nothing of the kind
    std::string_view hint; ///< what else to change, or ""
};

/// nullptr when the name is not one of the old ones.
const OldName* find_old_name(std::string_view family, std::string_view kind, std::string_view name);
/// The message: material "matte" is pbrt-v3's name; pbrt-v4 has "diffuse" (...)
std::string describe_old_name(const OldName& old);
/// What lenient loading takes instead: the name in v4; of a material that has none "diffuse", else "".
std::string_view stand_in_for(const OldName& old);
/// That instead, or leaving the thing out.
Remedy remedy_for(const OldName& old);

} // namespace alhazen
