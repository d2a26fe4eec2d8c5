#include "api/scene_model.h"

#include <algorithm>

#include <fmt/format.h>

#include "api/convert.h"
#include "formats/format.h"

namespace alhazen {

namespace {

/// Replaces the element of the same name, or adds one.
template <class T, class NameOf>
void replace_or_add(std::vector<T>& list, T element, NameOf name_of) {
    auto same = [&](const T& other) { return name_of(other) == name_of(element); };
    if (auto it = std::find_if(list.begin(), list.end(), same); it != list.end())
        *it = std::move(element);
    else
        list.push_back(std::move(element));
}

std::string owner_of(std::string_view family, std::string_view name) {
    return fmt::format("{} \"{}\"", family, name);
}

TextureNode make_texture_node(std::string name, std::string kind, Settings settings, const Pose& pose) {
    TextureNode texture;
    std::string owner = owner_of("texture", name);
    texture.node = to_node(std::move(kind), std::move(name), std::move(settings), owner);
    texture.world_from_texture = to_motion(pose);
    return texture;
}

/// The object of this name, made when there is none; "" is the scene itself.
ObjectNode& find_object(SceneDescription& description, const std::string& name) {
    if (name.empty()) return description.world;
    for (ObjectNode& object : description.objects)
        if (object.name == name) return object;
    ObjectNode object;
    object.name = name;
    object.place = Place::of_file(owner_of("object", name));
    description.objects.push_back(std::move(object));
    return description.objects.back();
}

int find_emitter(const SceneDescription& description, const std::string& name, const std::string& owner) {
    if (name.empty()) return -1;
    std::vector<std::string> known;
    for (std::size_t i = 0; i < description.area_lights.size(); ++i) {
        if (description.area_lights[i].name == name) return static_cast<int>(i);
        if (!description.area_lights[i].name.empty()) known.push_back(description.area_lights[i].name);
    }
    throw make_input_error(owner, fmt::format("unknown emitter \"{}\"{}", name, did_you_mean(name, known)));
}

void add_shape(SceneDescription& description, Node node, ShapeOptions options, const std::string& owner) {
    ShapeNode shape;
    shape.node = std::move(node);
    shape.world_from_object = to_motion(options.pose);
    shape.reverse_orientation = options.reverse_orientation;
    shape.material_name = std::move(options.material);
    shape.area_light = find_emitter(description, options.emitter, owner);
    find_object(description, options.object).shapes.push_back(std::move(shape));
}

/// "shape 3 (sphere)": shapes have no names, so they are counted.
std::string shape_owner(const SceneDescription& description, const std::string& object,
                        std::string_view kind) {
    std::size_t number = 1;
    if (object.empty()) number = description.world.shapes.size() + 1;
    for (const ObjectNode& known : description.objects)
        if (!object.empty() && known.name == object) number = known.shapes.size() + 1;
    std::string of = object.empty() ? "" : fmt::format(" of object \"{}\"", object);
    return fmt::format("shape {} ({}){}", number, kind, of);
}

} // namespace

SceneModel::SceneModel() : content_(std::make_unique<Content>()) {}
SceneModel::SceneModel(const SceneModel& other) : content_(std::make_unique<Content>(*other.content_)) {}
SceneModel::SceneModel(SceneModel&&) noexcept = default;
SceneModel& SceneModel::operator=(SceneModel&&) noexcept = default;
SceneModel& SceneModel::operator=(const SceneModel& other) {
    if (this != &other) content_ = std::make_unique<Content>(*other.content_);
    return *this;
}
SceneModel::~SceneModel() = default;

SceneModel SceneModel::from_file(const std::filesystem::path& file, bool lenient) {
    SceneModel scene;
    Messages messages;
    messages.lenient = scene.content_->lenient = lenient;
    try {
        scene.content_->description = read_scene(file, messages);
    } catch (const SceneError& error) {
        throw to_input_error(error);
    }
    scene.content_->warnings = messages.warnings();
    return scene;
}

SceneModel SceneModel::from_text(std::string_view text, const std::filesystem::path& folder, bool lenient) {
    SceneModel scene;
    Messages messages;
    messages.lenient = scene.content_->lenient = lenient;
    try {
        scene.content_->description = read_pbrt_string(text, folder, messages);
    } catch (const SceneError& error) {
        throw to_input_error(error);
    }
    scene.content_->warnings = messages.warnings();
    return scene;
}

SceneModel& SceneModel::camera(std::string kind, Settings settings, Pose pose) {
    CameraNode camera;
    std::string owner = owner_of("camera", kind);
    camera.node = to_node(std::move(kind), "", std::move(settings), owner);
    camera.world_from_camera = to_motion(pose);
    content_->description.cameras.push_back(std::move(camera));
    return *this;
}

SceneModel& SceneModel::film(std::string kind, Settings settings) {
    std::string owner = owner_of("film", kind);
    content_->description.film = to_node(std::move(kind), "", std::move(settings), owner);
    return *this;
}

SceneModel& SceneModel::filter(std::string kind, Settings settings) {
    std::string owner = owner_of("filter", kind);
    content_->description.filter = to_node(std::move(kind), "", std::move(settings), owner);
    return *this;
}

SceneModel& SceneModel::sampler(std::string kind, Settings settings) {
    std::string owner = owner_of("sampler", kind);
    content_->description.sampler = to_node(std::move(kind), "", std::move(settings), owner);
    return *this;
}

SceneModel& SceneModel::integrator(std::string kind, Settings settings) {
    std::string owner = owner_of("integrator", kind);
    content_->description.integrator = to_node(std::move(kind), "", std::move(settings), owner);
    return *this;
}

SceneModel& SceneModel::color_texture(std::string name, std::string kind, Settings settings, Pose pose) {
    replace_or_add(content_->description.textures,
                   make_texture_node(std::move(name), std::move(kind), std::move(settings), pose),
                   [](const TextureNode& t) { return std::pair(t.node.name, t.is_spectrum); });
    return *this;
}

SceneModel& SceneModel::number_texture(std::string name, std::string kind, Settings settings, Pose pose) {
    TextureNode texture = make_texture_node(std::move(name), std::move(kind), std::move(settings), pose);
    texture.is_spectrum = false;
    replace_or_add(content_->description.textures, std::move(texture),
                   [](const TextureNode& t) { return std::pair(t.node.name, t.is_spectrum); });
    return *this;
}

SceneModel& SceneModel::material(std::string name, std::string kind, Settings settings) {
    std::string owner = owner_of("material", name);
    if (name.empty()) throw make_input_error(owner, "a material must have a name");
    replace_or_add(content_->description.materials,
                   to_node(std::move(kind), std::move(name), std::move(settings), owner),
                   [](const Node& node) { return node.name; });
    return *this;
}

SceneModel& SceneModel::light(std::string kind, Settings settings, Pose pose) {
    LightNode light;
    std::string owner = fmt::format("light {} ({})", content_->description.lights.size() + 1, kind);
    light.node = to_node(std::move(kind), "", std::move(settings), owner);
    light.world_from_light = to_motion(pose);
    content_->description.lights.push_back(std::move(light));
    return *this;
}

SceneModel& SceneModel::emitter(std::string name, std::string kind, Settings settings) {
    std::string owner = owner_of("emitter", name);
    if (name.empty()) throw make_input_error(owner, "an emitter must have a name");
    replace_or_add(content_->description.area_lights,
                   to_node(std::move(kind), std::move(name), std::move(settings), owner),
                   [](const Node& node) { return node.name; });
    return *this;
}

SceneModel& SceneModel::shape(std::string kind, Settings settings, ShapeOptions options) {
    std::string owner = shape_owner(content_->description, options.object, kind);
    Node node = to_node(std::move(kind), "", std::move(settings), owner);
    add_shape(content_->description, std::move(node), std::move(options), owner);
    return *this;
}

SceneModel& SceneModel::mesh(MeshInput mesh, ShapeOptions options) {
    std::string owner = shape_owner(content_->description, options.object, "mesh");
    Node node;
    node.type = "trianglemesh";
    node.place = Place::of_file(owner);
    auto add = [&](std::string name, ValueType type, auto values) {
        if (values.empty()) return;
        Parameter p = make_array(std::move(name), type, std::move(values));
        p.place = node.place;
        node.parameters.push_back(std::move(p));
    };
    add("P", ValueType::point3, to_vec3s(mesh.positions, owner + ", positions"));
    add("indices", ValueType::integer, std::move(mesh.indices));
    add("N", ValueType::normal, to_vec3s(mesh.normals, owner + ", normals"));
    add("uv", ValueType::point2, to_vec2s(mesh.uv, owner + ", uv"));
    add_shape(content_->description, std::move(node), std::move(options), owner);
    return *this;
}

SceneModel& SceneModel::instance(std::string object, Pose pose, std::string inside_object) {
    InstanceNode instance;
    instance.place = Place::of_file(fmt::format("instance of \"{}\"", object));
    instance.object = std::move(object);
    instance.world_from_instance = to_motion(pose);
    find_object(content_->description, inside_object).instances.push_back(std::move(instance));
    return *this;
}

} // namespace alhazen
