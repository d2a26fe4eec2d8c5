#include "accel/accel.h"

#include "accel/build/linked_tree.h"
#include "accel/build/reinsertion.h"
#include "base/messages.h"

namespace alhazen {

namespace {

template <class Entry>
const Entry* find(std::span<const Entry> entries, std::string_view name) {
    for (const Entry& e : entries)
        if (e.name == name) return &e;
    return nullptr;
}

template <class Entry>
std::string unknown(std::string_view what, std::string_view name, std::span<const Entry> entries) {
    std::vector<std::string> names;
    for (const Entry& e : entries) names.emplace_back(e.name);
    return "unknown " + std::string(what) + " \"" + std::string(name) + "\"" + did_you_mean(name, names);
}

constexpr std::string_view reinsertion = "reinsertion";

// "lbvh+reinsertion" is the builder lbvh and the optimiser reinsertion.
struct BuilderName {
    std::string_view builder;
    std::optional<std::string_view> optimiser;

    explicit BuilderName(std::string_view name) {
        std::size_t plus = name.find('+');
        builder = name.substr(0, plus);
        if (plus != std::string_view::npos) optimiser = name.substr(plus + 1);
    }
};

std::string unknown_optimiser(std::string_view name) {
    std::vector<std::string> names{std::string(reinsertion)};
    return "unknown optimiser \"" + std::string(name) + "\" after a builder" + did_you_mean(name, names);
}

} // namespace

std::optional<AccelChoice> parse_accel(std::string_view text, std::string& error) {
    AccelChoice choice;
    if (text == "sdf") {
        choice.distance_field = usual_distance_field;
        return choice;
    }
    std::size_t slash = text.find('/');
    std::string_view builder = text.substr(0, slash);
    std::string_view walk = slash == std::string_view::npos ? std::string_view{} : text.substr(slash + 1);
    // Without a builder's name what follows the plus belongs to the usual builder.
    if (builder.starts_with('+'))
        choice.builder += builder;
    else if (!builder.empty())
        choice.builder = builder;
    if (!walk.empty()) choice.walk = walk;
    BuilderName name(choice.builder);
    if (!find(accel_builders(), name.builder)) {
        error = unknown("builder", name.builder, accel_builders());
        return std::nullopt;
    }
    if (name.optimiser && *name.optimiser != reinsertion) {
        error = unknown_optimiser(*name.optimiser);
        return std::nullopt;
    }
    if (!find(accel_walks(), choice.walk)) {
        error = unknown("walk", choice.walk, accel_walks());
        return std::nullopt;
    }
    return choice;
}

Tree build_tree(const Primitives& primitives, const AccelChoice& choice) {
    BuildOptions wants = find(accel_walks(), choice.walk)->wants;
    // Only triangles are tested together.
    if (primitives.kinds().custom) wants.joined = 0;
    std::vector<Bounds3> boxes = padded_boxes(primitives);
    BuilderName name(choice.builder);
    const AccelBuilder& builder = *find(accel_builders(), name.builder);
    if (!name.optimiser) return builder.build(primitives, boxes, wants);
    // Single primitives find better places than leaves of several do.
    BuildOptions singly = wants;
    singly.leaf_size = 1;
    singly.joined = 0;
    Tree tree = builder.build(primitives, boxes, singly);
    optimize_by_reinsertion(tree);
    collapse_leaves(tree, wants);
    return tree;
}

std::unique_ptr<Structure> make_structure(const Primitives& primitives, const AccelChoice& choice) {
    return make_structure(primitives, build_tree(primitives, choice), choice);
}

std::unique_ptr<Structure> make_structure(const Primitives& primitives, const Tree& tree,
                                          const AccelChoice& choice) {
    return find(accel_walks(), choice.walk)->make(primitives, tree, choice.walk_options);
}

} // namespace alhazen
