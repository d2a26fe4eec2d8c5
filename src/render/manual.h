/// The reference manual, printed from the one place where parameters are declared.
#pragma once

#include <string>

#include "describe/fields.h"
#include "render/families.h"

namespace alhazen {

/// One kind as plain text for a terminal of the given width.
std::string kind_text(const FamilyInfo& family, const KindDoc& kind, int columns);
/// How a scene writes colours, and the spectra that have names.
std::string spectra_text(int columns);
/// A family: its kinds, a line each.
std::string family_text(const FamilyInfo& family);
/// A family as a Markdown page.
std::string family_markdown(const FamilyInfo& family);

} // namespace alhazen
