/// The way from primitives to a structure: a builder and a walk chosen by name.
#pragma once

#include <optional>
#include <ostream>
#include <string>

#include "accel/list.h"

namespace alhazen {

/// A pair, written "builder/walk". A builder may be followed by "+reinsertion": its tree is improved
/// afterwards.
struct AccelChoice {
    std::string builder = "sah";
    std::string walk = "wide";
    WalkOptions walk_options;

    std::string name() const { return builder + "/" + walk; }
    friend std::ostream& operator<<(std::ostream& to, const AccelChoice& choice) {
        return to << choice.name();
    }
};

/// Reads "builder/walk", "builder" or "/walk", where "+reinsertion" may follow the builder. On error returns
/// nullopt and sets error: what is unknown, and what there is.
std::optional<AccelChoice> parse_accel(std::string_view text, std::string& error);

/// The tree and the structure for a choice of known names.
Tree build_tree(const Primitives& primitives, const AccelChoice& choice);
std::unique_ptr<Structure> make_structure(const Primitives& primitives, const AccelChoice& choice = {});
/// The structure for a tree that is there already; the choice's builder does not matter.
std::unique_ptr<Structure> make_structure(const Primitives& primitives, const Tree& tree,
                                          const AccelChoice& choice);

} // namespace alhazen
