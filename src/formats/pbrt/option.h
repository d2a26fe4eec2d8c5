/// The names that pbrt's Option directive takes.
#pragma once

#include <string>

#include "describe/value.h"

namespace alhazen {

/// What the directive gives: the name in lower case without '-' and '_', as pbrt compares them.
std::string normal_option_name(std::string_view name);
/// What is wrong with this value for the option of that (normal) name, or ""; turns the value into the
/// option's type.
std::string check_option(const std::string& name, Parameter& value);

} // namespace alhazen
