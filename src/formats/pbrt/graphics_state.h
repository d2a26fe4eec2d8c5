/// What pbrt's directives set for those that follow, until the AttributeEnd that ends their block.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "color/color_space.h"
#include "describe/scene_description.h"

namespace alhazen {

/// The things Attribute gives default parameters to.
enum class DefaultsOf { shape, light, material, medium, texture };

/// A named material or medium in force, and the directive that named it.
struct NameInForce {
    std::string name;
    Place place;
};

struct GraphicsState {
    static constexpr unsigned start_bit = 1, end_bit = 2, both_bits = 3;

    Motion transform; ///< pbrt's current transformation matrix: world from object
    unsigned active_transforms = both_bits;
    bool reverse_orientation = false;
    const RgbColorSpace* color_space = &srgb_space();
    int material = -1; ///< index of an anonymous material; -1: see named_material
    NameInForce named_material;
    int area_light = -1;
    NameInForce inside_medium, outside_medium;
    /// Shared, as the state is copied at each AttributeBegin; nullptr for none.
    std::array<std::shared_ptr<const std::vector<Parameter>>, 5> defaults;
};

/// The block an AttributeBegin, TransformBegin or ObjectBegin opened.
struct OpenBlock {
    enum class Kind { attribute, object };
    Kind kind;
    Place place;
    std::string directive;
    GraphicsState saved;
};

/// All that an Import has for itself; it sees a copy of its importer's state, named coordinate systems
/// included.
struct ImportScope {
    GraphicsState state;
    std::vector<OpenBlock> open;
    std::map<std::string, Motion, std::less<>> coordinate_systems;
    bool in_object = false; ///< the importer has an object open, which stays its own to close
};

} // namespace alhazen
