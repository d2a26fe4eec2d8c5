/// Every family of things a scene can name, with its kinds as the manual documents them: the one list that
/// help, the reference pages, overrides and tests read.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "describe/fields.h"

namespace alhazen {

struct FamilyInfo {
    std::string name;      ///< "material", as in `alhazen help material`
    std::string directive; ///< how a pbrt scene names one: "Material"
    std::string about;
    std::function<std::vector<KindDoc>()> kinds;
};

const std::vector<FamilyInfo>& families();

} // namespace alhazen
