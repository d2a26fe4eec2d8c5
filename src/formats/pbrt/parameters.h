/// Parameter lists: "type name" followed by a value or by values in brackets.
#pragma once

#include <vector>

#include "describe/value.h"
#include "formats/pbrt/tokenizer.h"

namespace alhazen {

struct ParameterContext {
    Messages& messages;
    std::string color_space = "srgb"; ///< goes into every parameter, whatever its type
    bool rgb_lists = false;           ///< several colours in one rgb parameter (grids of a medium)
};

/// The parameters up to the first token that is not a string. Values that do not fit their type are added as
/// errors and their parameter is left out; throws SyntaxError where the text cannot be followed.
std::vector<Parameter> read_parameters(PbrtTokenizer& tokens, const ParameterContext& context);

} // namespace alhazen
