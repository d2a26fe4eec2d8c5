/// The directives that put things into the scene.
#include "formats/pbrt/builder.h"

#include <algorithm>

#include <fmt/format.h>

#include "formats/pbrt/option.h"
#include "formats/pbrt/tokenizer.h"
#include "formats/pbrt/version3.h"

namespace alhazen {

PbrtBuilder::PbrtBuilder(std::filesystem::path file, std::filesystem::path base_folder, Messages& messages)
    : messages_(messages) {
    scene_.file = std::move(file);
    scene_.base_folder = std::move(base_folder);
}

bool PbrtBuilder::check_options(std::string_view directive, const Place& place) {
    if (in_world_)
        messages_.add_error(place, fmt::format("{} after WorldBegin; expected it before", directive));
    return !in_world_;
}

bool PbrtBuilder::check_world(std::string_view directive, const Place& place) {
    if (!in_world_)
        messages_.add_error(place, fmt::format("{} before WorldBegin; expected it after", directive));
    return in_world_;
}

void PbrtBuilder::modernise(Node& node, std::string_view family) {
    if (const OldName* old = find_old_name(family, "", node.type)) {
        messages_.add_unsupported(node.place, describe_old_name(*old), remedy_for(*old));
        if (const std::string_view other = stand_in_for(*old); !other.empty()) node.type = other;
    }
    auto is_replaced = [&](Parameter& p) {
        const OldName* old = find_old_name("parameter", family, p.name);
        if (!old) return false;
        bool renamed = !old->now.empty() && old->hint.empty() && !node.find(old->now);
        messages_.add_unsupported(p.place, describe_old_name(*old),
                                  renamed ? remedy_for(*old) : Remedy::ignore());
        if (renamed) p.name = old->now;
        return !renamed;
    };
    std::erase_if(node.parameters, is_replaced);
}

void PbrtBuilder::add_defaults(Node& node, DefaultsOf of) {
    if (const auto& defaults = scope_.state.defaults[static_cast<std::size_t>(of)])
        for (const Parameter& p : *defaults)
            if (!node.find(p.name)) node.parameters.push_back(p);
}

bool PbrtBuilder::take_type(Node& node, std::string_view family, const Place& place) {
    node.name = std::move(node.type);
    node.type.clear();
    auto type = std::find_if(node.parameters.begin(), node.parameters.end(),
                             [](const auto& p) { return p.name == "type"; });
    const auto* words =
        type == node.parameters.end() ? nullptr : std::get_if<std::vector<std::string>>(&type->values);
    if (!words || words->size() != 1) {
        messages_.add_error(place,
                            fmt::format("{} \"{}\" has no \"string type\"", family, printable(node.name)));
        return false;
    }
    node.type = words->front();
    node.parameters.erase(type);
    return true;
}

void PbrtBuilder::set_one(Node& target, std::string_view family, std::string_view directive, Node node,
                          const Place& place) {
    if (!check_options(directive, place)) return;
    modernise(node, family);
    target = std::move(node);
}

void PbrtBuilder::option(const std::string& name, Parameter value, Place place) {
    Node option;
    option.type = normal_option_name(name);
    option.place = place;
    std::string fault = check_option(option.type, value);
    if (!fault.empty()) {
        messages_.add_error(std::move(place), std::move(fault));
        return;
    }
    value.name = "value";
    option.parameters.push_back(std::move(value));
    std::erase_if(scene_.options, [&](const Node& other) { return other.type == option.type; });
    scene_.options.push_back(std::move(option));
}

void PbrtBuilder::camera(Node node, Place place) {
    if (!check_options("Camera", place)) return;
    modernise(node, "camera");
    auto name = std::find_if(node.parameters.begin(), node.parameters.end(),
                             [](const auto& p) { return p.name == "name"; });
    if (name != node.parameters.end()) {
        const auto* words = std::get_if<std::vector<std::string>>(&name->values);
        if (!words || words->size() != 1) {
            messages_.add_error(name->place, "a camera's \"name\" is one string");
            return;
        }
        node.name = words->front();
    }
    auto& cameras = scene_.cameras;
    auto same = std::find_if(cameras.begin(), cameras.end(),
                             [&](const CameraNode& c) { return c.node.name == node.name; });
    if (same != cameras.end()) {
        // Without names, pbrt's rule holds: the last Camera counts. Two of one name are a mistake.
        if (!node.name.empty()) {
            messages_.add_error(place, fmt::format("two cameras named \"{}\"; the first is at {}",
                                                   printable(node.name), same->node.place.text()));
            return;
        }
        cameras.erase(same);
    }
    const Motion& camera_from_world = scope_.state.transform;
    // apply() lets no singular matrix in.
    Motion world_from_camera{camera_from_world.start.inverse().value_or(Matrix4{}),
                             camera_from_world.end.inverse().value_or(Matrix4{})};
    scope_.coordinate_systems["camera"] = world_from_camera;
    cameras.push_back({std::move(node), world_from_camera, use_medium(scope_.state.outside_medium).name});
}

void PbrtBuilder::world_begin(Place place) {
    if (!check_options("WorldBegin", place)) return;
    in_world_ = true;
    scope_.state.transform = {};
    scope_.state.active_transforms = GraphicsState::both_bits;
    scope_.coordinate_systems["world"] = scope_.state.transform;
}

const NameInForce& PbrtBuilder::use_medium(const NameInForce& medium) {
    if (!medium.name.empty()) used_media_.try_emplace(medium.name, medium.place);
    return medium;
}

void PbrtBuilder::shape(Node node, Place place) {
    if (!check_world("Shape", place)) return;
    add_defaults(node, DefaultsOf::shape);
    modernise(node, "shape");
    const GraphicsState& state = scope_.state;
    ShapeNode shape;
    shape.node = std::move(node);
    shape.world_from_object = state.transform;
    shape.reverse_orientation = state.reverse_orientation;
    shape.material = state.material;
    shape.material_name = state.named_material.name;
    if (!shape.material_name.empty())
        used_materials_.try_emplace(shape.material_name, state.named_material.place);
    shape.area_light = state.area_light;
    shape.inside_medium = use_medium(state.inside_medium).name;
    shape.outside_medium = use_medium(state.outside_medium).name;
    target().shapes.push_back(std::move(shape));
}

void PbrtBuilder::light_source(Node node, Place place) {
    if (!check_world("LightSource", place)) return;
    add_defaults(node, DefaultsOf::light);
    modernise(node, "light");
    scene_.lights.push_back(
        {std::move(node), scope_.state.transform, use_medium(scope_.state.outside_medium).name});
}

void PbrtBuilder::area_light_source(Node node, Place place) {
    if (!check_world("AreaLightSource", place)) return;
    add_defaults(node, DefaultsOf::light);
    modernise(node, "light");
    scope_.state.area_light = static_cast<int>(scene_.area_lights.size());
    scene_.area_lights.push_back(std::move(node));
}

void PbrtBuilder::material(Node node, Place place) {
    if (!check_world("Material", place)) return;
    add_defaults(node, DefaultsOf::material);
    modernise(node, "material");
    scope_.state.material = static_cast<int>(scene_.materials.size());
    scope_.state.named_material = {};
    scene_.materials.push_back(std::move(node));
}

void PbrtBuilder::make_named_material(Node node, Place place) {
    if (!check_world("MakeNamedMaterial", place)) return;
    if (!material_names_.insert(node.type).second) {
        messages_.add_error(place, fmt::format("material \"{}\" is defined twice", printable(node.type)));
        return;
    }
    add_defaults(node, DefaultsOf::material);
    if (!take_type(node, "material", place)) return;
    modernise(node, "material");
    scene_.materials.push_back(std::move(node));
}

void PbrtBuilder::named_material(std::string name, Place place) {
    if (!check_world("NamedMaterial", place)) return;
    scope_.state.named_material = {std::move(name), std::move(place)};
    scope_.state.material = -1;
}

void PbrtBuilder::make_named_medium(Node node, Place place) {
    if (!medium_names_.insert(node.type).second) {
        messages_.add_error(place, fmt::format("medium \"{}\" is defined twice", printable(node.type)));
        return;
    }
    add_defaults(node, DefaultsOf::medium);
    if (!take_type(node, "medium", place)) return;
    modernise(node, "medium");
    scene_.media.push_back({std::move(node), false, scope_.state.transform});
}

void PbrtBuilder::texture(Node node, const std::string& value_type, Place place) {
    if (!check_world("Texture", place)) return;
    bool is_spectrum = value_type == "spectrum" || value_type == "color";
    if (value_type == "color")
        messages_.add_unsupported(
            place, "texture type \"color\" is an older pbrt's name; pbrt-v4 calls it \"spectrum\"",
            "\"spectrum\"");
    else if (!is_spectrum && value_type != "float") {
        messages_.add_error(
            place, fmt::format("texture \"{}\" is of type \"{}\"; expected \"float\" or \"spectrum\"",
                               printable(node.name), printable(value_type)));
        return;
    }
    if (!(is_spectrum ? spectrum_textures_ : float_textures_).insert(node.name).second) {
        messages_.add_error(place, fmt::format("{} texture \"{}\" is defined twice",
                                               is_spectrum ? "spectrum" : "float", printable(node.name)));
        return;
    }
    add_defaults(node, DefaultsOf::texture);
    modernise(node, "texture");
    scene_.textures.push_back({std::move(node), is_spectrum, scope_.state.transform});
}

void PbrtBuilder::sdf(Node node, Place place) {
    if (!check_world("Sdf", place)) return;
    if (!sdf_names_.insert(node.name).second) {
        messages_.add_error(place, fmt::format("sdf \"{}\" is defined twice", printable(node.name)));
        return;
    }
    scene_.sdfs.push_back({std::move(node), false, scope_.state.transform});
}

void PbrtBuilder::object_begin(std::string name, Place place) {
    if (!check_world("ObjectBegin", place)) return;
    scope_.open.push_back({OpenBlock::Kind::object, place, "ObjectBegin", scope_.state});
    if (object_)
        messages_.add_error(std::move(place),
                            fmt::format("ObjectBegin inside the object \"{}\"; expected its ObjectEnd "
                                        "first (an ObjectInstance may be inside)",
                                        printable(object_->name)));
    else if (!object_names_.insert(name).second)
        messages_.add_error(std::move(place), fmt::format("object \"{}\" is defined twice", printable(name)));
    else
        object_.emplace(ObjectNode{std::move(name), std::move(place), {}, {}});
}

void PbrtBuilder::object_end(Place place) {
    if (check_world("ObjectEnd", place)) close_block(OpenBlock::Kind::object, "ObjectEnd", place);
}

void PbrtBuilder::object_instance(std::string name, Place place) {
    if (!check_world("ObjectInstance", place)) return;
    target().instances.push_back({std::move(name), scope_.state.transform, std::move(place)});
}

void PbrtBuilder::check_names() {
    auto check = [&](const auto& used, const auto& defined, std::string_view family) {
        std::vector<std::string> known(defined.begin(), defined.end());
        for (const auto& [name, place] : used)
            if (!defined.contains(name))
                messages_.add_error(
                    place, fmt::format("no {} \"{}\"{}", family, printable(name), did_you_mean(name, known)));
    };
    check(used_materials_, material_names_, "material");
    check(used_media_, medium_names_, "medium");
}

SceneDescription PbrtBuilder::finish(Place end) {
    report_open_blocks();
    if (!in_world_) messages_.add_error(std::move(end), "the file ends before WorldBegin");
    // A definition lost to an error would be missed here for that reason alone.
    if (messages_.error_count() == 0) {
        check_names();
        check_objects(scene_, messages_);
    }
    messages_.throw_if_errors();
    return std::move(scene_);
}

} // namespace alhazen
