/// Whether the objects' instances make a scene: each refers to an object that is there, none to one it is
/// part of.
#include <algorithm>
#include <unordered_map>

#include <fmt/format.h>

#include "formats/pbrt/builder.h"
#include "formats/pbrt/tokenizer.h"

namespace alhazen {

namespace {

// Rays carry a stack through the levels; no scene needs many.
constexpr int deepest_objects = 64;

struct ObjectGraph {
    const SceneDescription& scene;
    std::unordered_map<std::string_view, std::size_t> number_of;
    std::vector<int> height; ///< levels of objects below and including each; 0 until known

    explicit ObjectGraph(const SceneDescription& s) : scene(s), height(s.objects.size(), 0) {
        for (std::size_t i = 0; i < s.objects.size(); ++i) number_of.emplace(s.objects[i].name, i);
    }
};

void check_defined(const ObjectNode& holder, const ObjectGraph& graph, Messages& messages) {
    for (const InstanceNode& instance : holder.instances) {
        if (graph.number_of.contains(instance.object)) continue;
        std::vector<std::string> known;
        for (const ObjectNode& object : graph.scene.objects) known.push_back(object.name);
        messages.add_error(instance.place, fmt::format("no object \"{}\"{}", printable(instance.object),
                                                       did_you_mean(instance.object, known)));
    }
}

/// Heights, from the objects without instances upwards (Kahn 1962); 0 is left for those on or above a cycle.
void find_heights(ObjectGraph& graph) {
    const auto& objects = graph.scene.objects;
    std::vector<std::vector<std::size_t>> users(objects.size());
    std::vector<std::size_t> waiting(objects.size(), 0), ready;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        for (const InstanceNode& instance : objects[i].instances)
            users[graph.number_of.at(instance.object)].push_back(i);
        waiting[i] = objects[i].instances.size();
        if (waiting[i] == 0) ready.push_back(i);
    }
    std::vector<int> below(objects.size(), 0);
    while (!ready.empty()) {
        std::size_t i = ready.back();
        ready.pop_back();
        graph.height[i] = below[i] + 1;
        for (std::size_t user : users[i]) {
            below[user] = std::max(below[user], graph.height[i]);
            if (--waiting[user] == 0) ready.push_back(user);
        }
    }
}

/// The first instance in the object whose own height is not known either: the next step round a cycle.
const InstanceNode* step_up(const ObjectGraph& graph, std::size_t object) {
    for (const InstanceNode& instance : graph.scene.objects[object].instances)
        if (graph.height[graph.number_of.at(instance.object)] == 0) return &instance;
    return nullptr;
}

void report_cycle(const ObjectGraph& graph, Messages& messages) {
    auto unknown = std::find(graph.height.begin(), graph.height.end(), 0);
    if (unknown == graph.height.end()) return;
    auto at = static_cast<std::size_t>(unknown - graph.height.begin());
    // After as many steps as there are objects the walk is on the cycle itself.
    for (std::size_t i = 0; i < graph.height.size(); ++i) at = graph.number_of.at(step_up(graph, at)->object);
    std::size_t first = at;
    const InstanceNode* instance = step_up(graph, first);
    Place place = instance->place;
    std::string way = fmt::format("\"{}\"", printable(graph.scene.objects[first].name));
    for (int shown = 0;; ++shown) {
        at = graph.number_of.at(instance->object);
        if (shown < 10) way += fmt::format(" > \"{}\"", printable(instance->object));
        if (at == first) break;
        instance = step_up(graph, at);
    }
    messages.add_error(place, fmt::format("object \"{}\" contains itself: {}",
                                          printable(graph.scene.objects[first].name), way));
}

} // namespace

void check_objects(const SceneDescription& scene, Messages& messages) {
    ObjectGraph graph(scene);
    std::size_t errors = messages.error_count();
    check_defined(scene.world, graph, messages);
    for (const ObjectNode& object : scene.objects) check_defined(object, graph, messages);
    if (messages.error_count() != errors) return;
    find_heights(graph);
    report_cycle(graph, messages);
    for (std::size_t i = 0; i < scene.objects.size(); ++i)
        if (graph.height[i] == deepest_objects + 1)
            messages.add_error(scene.objects[i].place,
                               fmt::format("object \"{}\" holds objects nested more than {} deep",
                                           printable(scene.objects[i].name), deepest_objects));
}

} // namespace alhazen
