/// What a comparison found, as the page reads it.
#pragma once

#include <nlohmann/json.hpp>

#include "lab/reference_comparison.h"

namespace alhazen::bench {

using Json = nlohmann::ordered_json;

Json to_json(const ReferenceComparison& c);

} // namespace alhazen::bench
