/// Parameters set from the command line: the path names a node, the text is read as the parameter's declared
/// type.
#include <charconv>
#include <sstream>

#include <fmt/format.h>

#include "render/families.h"
#include "render/world.h"

namespace alhazen {

namespace {

struct Target {
    Node* node = nullptr;
    std::string family;
};

template <class List, class NodeOf>
Node* find_named(List& list, const std::string& name, NodeOf node_of) {
    for (auto& item : list)
        if (node_of(item).name == name) return &node_of(item);
    std::size_t index = 0;
    auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), index);
    if (error == std::errc{} && end == name.data() + name.size() && index < list.size())
        return &node_of(list[index]);
    return nullptr;
}

// The node that path ("integrator", "material.Floor") names.
Target find_target(SceneDescription& scene, const std::string& path) {
    auto dot = path.find('.');
    std::string family = path.substr(0, dot);
    auto plain = [](auto& n) -> Node& {
        if constexpr (requires { n.node; })
            return n.node;
        else
            return n;
    };
    if (dot == std::string::npos) {
        if (family == "integrator") return {&scene.integrator, family};
        if (family == "film") return {&scene.film, family};
        if (family == "sampler") return {&scene.sampler, family};
        if (family == "filter") return {&scene.filter, family};
        if (family == "accelerator") return {&scene.accelerator, family};
        if (family == "camera" && !scene.cameras.empty()) return {&scene.cameras.back().node, family};
        return {};
    }
    std::string name = path.substr(dot + 1);
    if (family == "material") return {find_named(scene.materials, name, plain), family};
    if (family == "light") return {find_named(scene.lights, name, plain), family};
    if (family == "area-light") return {find_named(scene.area_lights, name, plain), family};
    if (family == "texture") {
        Node* node = find_named(scene.textures, name, plain);
        bool is_spectrum = false;
        for (const TextureNode& t : scene.textures)
            if (&t.node == node) is_spectrum = t.is_spectrum;
        return {node, is_spectrum ? "spectrum-texture" : "float-texture"};
    }
    if (family == "sdf") return {find_named(scene.sdfs, name, plain), family};
    if (family == "medium") return {find_named(scene.media, name, plain), family};
    if (family == "camera") return {find_named(scene.cameras, name, plain), family};
    if (family == "shape") return {find_named(scene.world.shapes, name, plain), family};
    return {};
}

// The names that a path may have, for suggestions.
std::vector<std::string> known_paths(const SceneDescription& scene) {
    std::vector<std::string> paths{"integrator", "camera", "film", "filter", "sampler", "accelerator"};
    auto add = [&](std::string_view family, const Node& node) {
        if (!node.name.empty()) paths.push_back(fmt::format("{}.{}", family, node.name));
    };
    for (const Node& node : scene.materials) add("material", node);
    for (const TextureNode& t : scene.textures) add("texture", t.node);
    for (const TextureNode& m : scene.media) add("medium", m.node);
    for (const TextureNode& s : scene.sdfs) add("sdf", s.node);
    for (const CameraNode& c : scene.cameras) add("camera", c.node);
    return paths;
}

std::string default_type(const std::string& family) {
    if (family == "integrator") return "volpath";
    if (family == "film") return "rgb";
    if (family == "sampler") return "zsobol";
    if (family == "accelerator") return "bvh";
    return "gaussian";
}

std::optional<std::vector<float>> read_numbers(std::string text) {
    std::replace(text.begin(), text.end(), ',', ' ');
    std::istringstream in(text);
    std::vector<float> numbers;
    float v = 0;
    while (in >> v) numbers.push_back(v);
    if (!in.eof()) return std::nullopt;
    return numbers;
}

std::optional<Parameter> make_integer_parameter(const FieldDoc& field, const std::string& value) {
    int number = 0;
    auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (error != std::errc{} || end != value.data() + value.size()) return std::nullopt;
    return make_integer(field.name, number);
}

// The value as one of the types the field takes: numbers where it takes numbers, else a string.
std::optional<Parameter> make_parameter(const SceneDescription& scene, const FieldDoc& field,
                                        const std::string& value) {
    auto takes = [&](std::string_view type) { return field.type.find(type) != std::string::npos; };
    if (takes("bool")) {
        if (value != "true" && value != "false") return std::nullopt;
        return make_bool(field.name, value == "true");
    }
    if (takes("string") || takes("\"")) return make_string(field.name, value);
    if (field.type == "integer") return make_integer_parameter(field, value);
    auto numbers = read_numbers(value);
    if (!numbers || numbers->empty()) {
        bool names_texture = std::any_of(scene.textures.begin(), scene.textures.end(),
                                         [&](const TextureNode& t) { return t.node.name == value; });
        if (takes("texture") && (names_texture || !takes("spectrum"))) return make_texture(field.name, value);
        if (takes("spectrum")) return make_spectrum(field.name, value);
        return std::nullopt;
    }
    const auto& v = *numbers;
    if (takes("float") && v.size() == 1) return make_float(field.name, v[0]);
    if (takes("float[]")) return make_array(field.name, ValueType::real, v);
    if (takes("rgb") && v.size() == 3) return make_rgb(field.name, v[0], v[1], v[2]);
    if (takes("point3") && v.size() == 3) return make_point3(field.name, {v[0], v[1], v[2]});
    if (takes("point2") && v.size() == 2)
        return make_array<Vec2>(field.name, ValueType::point2, {Vec2{v[0], v[1]}});
    return std::nullopt;
}

std::optional<KindDoc> find_doc(const std::string& family, const std::string& type) {
    for (const FamilyInfo& info : families())
        if (info.name == family)
            for (KindDoc& doc : info.kinds())
                if (doc.name == type) return std::move(doc);
    return std::nullopt;
}

} // namespace

void apply_override(SceneDescription& scene, const std::string& text, Messages& messages) {
    auto fail = [&](const std::string& why) {
        messages.add_error({}, fmt::format("--set {}: {}", text, why));
    };
    auto equals = text.find('=');
    auto dot = text.rfind('.', equals);
    if (equals == std::string::npos || dot == std::string::npos || dot == 0)
        return fail("write it as FAMILY.PARAMETER=VALUE or FAMILY.NAME.PARAMETER=VALUE");
    std::string path = text.substr(0, dot), name = text.substr(dot + 1, equals - dot - 1);
    std::string value = text.substr(equals + 1);

    Target target = find_target(scene, path);
    if (!target.node)
        return fail(
            fmt::format("the scene has no \"{}\"; one can set integrator, camera, film, filter, sampler, "
                        "accelerator, camera.NAME, material.NAME, texture.NAME, medium.NAME, sdf.NAME, "
                        "light.NUMBER, area-light.NUMBER, shape.NUMBER{}",
                        path, did_you_mean(path, known_paths(scene))));
    if (target.node->type.empty()) target.node->type = default_type(target.family);
    auto doc = find_doc(target.family, target.node->type);
    if (!doc) return; // the unknown type is reported when the scene is built
    std::vector<std::string> known;
    for (const FieldDoc& field : doc->fields) {
        known.push_back(field.name);
        if (field.name != name) continue;
        if (auto parameter = make_parameter(scene, field, value)) {
            parameter->place = Place::of_file("--set " + text);
            return target.node->set(std::move(*parameter));
        }
        return fail(fmt::format("\"{}\" is not a value of type {}", value, field.type));
    }
    fail(fmt::format("{} \"{}\" has no parameter \"{}\"{}", target.family, target.node->type, name,
                     did_you_mean(name, known)));
}

} // namespace alhazen
