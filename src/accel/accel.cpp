#include "accel/accel.h"

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

} // namespace

std::optional<AccelChoice> parse_accel(std::string_view text, std::string& error) {
    AccelChoice choice;
    std::size_t slash = text.find('/');
    std::string_view builder = text.substr(0, slash);
    std::string_view walk = slash == std::string_view::npos ? std::string_view{} : text.substr(slash + 1);
    if (!builder.empty()) choice.builder = builder;
    if (!walk.empty()) choice.walk = walk;
    if (!find(accel_builders(), choice.builder)) {
        error = unknown("builder", choice.builder, accel_builders());
        return std::nullopt;
    }
    if (!find(accel_walks(), choice.walk)) {
        error = unknown("walk", choice.walk, accel_walks());
        return std::nullopt;
    }
    return choice;
}

Tree build_tree(const Primitives& primitives, const AccelChoice& choice) {
    const AccelWalk& walk = *find(accel_walks(), choice.walk);
    return find(accel_builders(), choice.builder)->build(primitives, padded_boxes(primitives), walk.wants);
}

std::unique_ptr<Structure> make_structure(const Primitives& primitives, const AccelChoice& choice) {
    return find(accel_walks(), choice.walk)
        ->make(primitives, build_tree(primitives, choice), choice.walk_options);
}

} // namespace alhazen
