/// alhazen info: what is in a scene.
#include <map>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/threads.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "formats/format.h"
#include "lab/json_text.h"
#include "render/world.h"

namespace alhazen {

namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions {
    std::string scene;
    SceneOptions scene_options;
    bool json = false;
};

// How many there are of each type.
template <class List, class NodeOf>
Json count_types(const List& list, NodeOf node_of) {
    std::map<std::string, int> counts;
    for (const auto& item : list) ++counts[node_of(item).type];
    return Json(counts);
}

Json vector_json(Vec3 v) {
    return {v.x, v.y, v.z};
}

// Of a texture or a medium.
Json describe_named(const Node& node) {
    Json json{{"name", node.name}, {"type", node.type}};
    if (const Parameter* file = node.find("filename"))
        if (auto* names = std::get_if<std::vector<std::string>>(&file->values); names && !names->empty())
            json["file"] = names->front();
    return json;
}

// What the description alone tells; the parameters are gone once the world is built.
Json describe_nodes(const SceneDescription& scene) {
    auto node_of = [](const auto& item) -> const Node& { return item.node; };
    auto itself = [](const Node& node) -> const Node& { return node; };
    Json json;
    std::map<std::string, int> shapes;
    for (const ShapeNode& s : scene.world.shapes) ++shapes[s.node.type];
    for (const ObjectNode& object : scene.objects)
        for (const ShapeNode& s : object.shapes) ++shapes[s.node.type];
    json["shapes"] = shapes;
    json["materials"] = count_types(scene.materials, itself);
    json["lights"] = count_types(scene.lights, node_of);
    json["area_lights"] = count_types(scene.area_lights, itself);
    json["textures"] = Json::array();
    for (const TextureNode& t : scene.textures) {
        Json texture = describe_named(t.node);
        texture["value"] = t.is_spectrum ? "spectrum" : "float";
        json["textures"].push_back(texture);
    }
    json["media"] = Json::array();
    for (const TextureNode& medium : scene.media) json["media"].push_back(describe_named(medium.node));
    json["objects"] = scene.objects.size();
    return json;
}

void add_world(Json& json, const World& world) {
    SceneCounts counts = world.scene->counts();
    json["primitives"] = counts.primitives;
    json["triangles"] = counts.triangles;
    json["instances"] = counts.instances;
    json["light_count"] = world.scene->lights().size();
    json["accelerator_bytes"] = counts.accel_bytes;
    for (Json& texture : json["textures"]) {
        auto size = world.textures.image_size(texture["name"].get<std::string>());
        if (!size) continue;
        texture["width"] = size->x;
        texture["height"] = size->y;
    }
    json["texture_bytes"] = world.textures.bytes();
    json["shape_bytes"] = counts.shape_bytes;
    json["memory_bytes"] = counts.accel_bytes + counts.shape_bytes + world.textures.bytes();
    const Bounds3& b = world.scene->bounds();
    if (!b.empty()) json["bounds"] = {{"min", vector_json(b.lo)}, {"max", vector_json(b.hi)}};
    json["film"] = {{"width", world.film->resolution().x}, {"height", world.film->resolution().y}};
    json["samples_per_pixel"] = world.spp;
}

std::string types_text(const Json& counts) {
    std::string text;
    for (const auto& [type, count] : counts.items())
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count.get<int>(), type);
    return text.empty() ? "none" : text;
}

std::string bytes_text(double bytes) {
    if (bytes < 1e6) return fmt::format("{:.1f} kB", bytes / 1e3);
    if (bytes < 1e9) return fmt::format("{:.1f} MB", bytes / 1e6);
    return fmt::format("{:.2f} GB", bytes / 1e9);
}

std::string file_text(const Json& named) {
    return named.contains("file") ? "  " + named["file"].get<std::string>() : "";
}

void print_text(const Json& j) {
    fmt::print("{}\n", j["scene"].get<std::string>());
    fmt::print("  film         {} x {}, {} spp\n", j["film"]["width"].get<int>(),
               j["film"]["height"].get<int>(), j["samples_per_pixel"].get<int>());
    fmt::print("  shapes       {}\n", types_text(j["shapes"]));
    fmt::print("  primitives   {} ({} triangles)\n", j["primitives"].get<std::size_t>(),
               j["triangles"].get<std::size_t>());
    fmt::print("  instances    {} of {} objects\n", j["instances"].get<std::size_t>(),
               j["objects"].get<std::size_t>());
    fmt::print("  materials    {}\n", types_text(j["materials"]));
    fmt::print("  lights       {}; area lights: {}; {} in all\n", types_text(j["lights"]),
               types_text(j["area_lights"]), j["light_count"].get<std::size_t>());
    fmt::print("  textures     {}\n", j["textures"].size());
    for (const Json& t : j["textures"]) {
        std::string size = t.contains("width")
                               ? fmt::format("  {} x {}", t["width"].get<int>(), t["height"].get<int>())
                               : "";
        fmt::print("    {:<24}{} {}{}{}\n", t["name"].get<std::string>(), t["value"].get<std::string>(),
                   t["type"].get<std::string>(), size, file_text(t));
    }
    fmt::print("  media        {}\n", j["media"].size());
    for (const Json& medium : j["media"])
        fmt::print("    {:<24}{}{}\n", medium["name"].get<std::string>(), medium["type"].get<std::string>(),
                   file_text(medium));
    if (j.contains("bounds")) {
        auto corner = [&](const char* key) {
            const Json& v = j["bounds"][key];
            return fmt::format("({:.6g}, {:.6g}, {:.6g})", v[0].get<double>(), v[1].get<double>(),
                               v[2].get<double>());
        };
        fmt::print("  bounds       {} to {}\n", corner("min"), corner("max"));
    }
    fmt::print("  memory       {} (accelerator {}, shapes {}, textures {})\n",
               bytes_text(j["memory_bytes"].get<double>()), bytes_text(j["accelerator_bytes"].get<double>()),
               bytes_text(j["shape_bytes"].get<double>()), bytes_text(j["texture_bytes"].get<double>()));
}

int run_info(const InfoOptions& options) {
    Messages messages;
    messages.lenient = options.scene_options.lenient;
    Json json;
    json["scene"] = options.scene;
    with_threads(options.scene_options.settings.threads, [&] {
        SceneDescription description = read_scene(options.scene, messages);
        json.update(describe_nodes(description));
        auto world = build_world(std::move(description), options.scene_options.settings, messages);
        add_world(json, *world);
    });
    for (const Message& m : messages.warnings()) fmt::print(stderr, "{}\n", m.full_text());
    if (options.json)
        fmt::print("{}", json_text(json));
    else
        print_text(json);
    return exit_ok;
}

} // namespace

void add_info_command(CLI::App& app, Action& action) {
    auto options = std::make_shared<InfoOptions>();
    CLI::App* command = app.add_subcommand("info", "say what is in a scene");
    command->add_option("SCENE", options->scene, "scene file (.pbrt)")->required();
    command->add_flag("--json", options->json, "as JSON");
    add_scene_options(*command, options->scene_options);
    command->callback([options, &action] { action = [options] { return run_info(*options); }; });
}

} // namespace alhazen
