/// A report as others read it: JSON for programs, a page for people.
#pragma once

#include <string>

#include "lab/measure.h"

namespace alhazen {

/// A list with one record a walk, rays, query and mode.
std::string to_json(const LabReport& report);

/// One page that needs nothing else: plots, numbers, pictures of the nodes visited, and what each builder and
/// walk does.
std::string to_html(const LabReport& report);

/// What a builder or a walk does, in a few sentences; its line in the list of builders where there is no
/// more.
std::string explain_builder(std::string_view name);
std::string explain_walk(std::string_view name);

} // namespace alhazen
