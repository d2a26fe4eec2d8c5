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
    /// Cells along the scene's longest side of the global distance field that answers, approximately, all
    /// rays but those from the camera; 0: none.
    int distance_field = 0;

    std::string name() const { return distance_field > 0 ? "sdf" : builder + "/" + walk; }
    friend std::ostream& operator<<(std::ostream& to, const AccelChoice& choice) {
        return to << choice.name();
    }
};

/// Cells of "sdf", when nobody says how many.
inline constexpr int usual_distance_field = 128;

/// Reads "builder/walk", "builder" or "/walk", where "+reinsertion" may follow the builder; or "sdf", which
/// is the usual pair and a distance field. On error returns nullopt and sets error: what is unknown, and what
/// there is.
std::optional<AccelChoice> parse_accel(std::string_view text, std::string& error);

/// The tree and the structure for a choice of known names.
Tree build_tree(const Primitives& primitives, const AccelChoice& choice);
std::unique_ptr<Structure> make_structure(const Primitives& primitives, const AccelChoice& choice = {});
/// The structure for a tree that is there already; the choice's builder does not matter.
std::unique_ptr<Structure> make_structure(const Primitives& primitives, const Tree& tree,
                                          const AccelChoice& choice);

} // namespace alhazen
